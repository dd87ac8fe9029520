# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Definitions and texts of a benchmark for its page and the terminal."""

from collections.abc import Iterator

from ddct_bringup.benchmark.comparison import COMPARED
from ddct_bringup.benchmark.gaps import OF_QUANTITIES, OF_SHARES, SUCCESS
from ddct_bringup.benchmark.result_types import Evaluation, JudgedResult, Result
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.campaign_report.statistics.outcome import CONFIDENCE, METHOD
from ddct_bringup.campaign_report.texts import RULES as CAMPAIGN_RULES
from ddct_bringup.campaign_report.texts import state_text
from ddct_bringup.metrics.catalogue import METRICS

RULES = {
    'development': 'Cases that are fixed in a release, and that anyone may tune a controller on.',
    'held out': 'Cases of the same kinds whose seed follows from the digests of controller and '
    'release: nobody can tune a controller on its own. A judge may give another seed.',
    'success': 'The run is valid, and its state is engaged or nearly engaged. An invalid run is '
    'no success.',
    'interval': f'{METHOD}, {100.0 * CONFIDENCE:g} %.',
    'gap': f'Both sets are samples of the same cases. {OF_SHARES} for the share of successes, '
    f'{OF_QUANTITIES} for the quantities of engaged runs; p is below 0.05 over the number of '
    'figures where the difference is beyond chance. A controller that remembers the development '
    'cases shows here.',
    'P50, P95, worst': 'Of the engaged runs that have a value; the worst is the largest '
    'magnitude. Other runs have no place among them: their share is in the first table.',
    'over the least': 'The value over the least that any controller could have that locks at the '
    'same instant. Only the first samples of each scenario have it, and only runs that lock once '
    'and stay locked.',
    'avoidable limits': 'In the cases with floors, limits that a controller could keep: those '
    'below the least at any lock instant are left out. A run that is no success keeps none.',
    'explained': CAMPAIGN_RULES['explained'],
    'drives': CAMPAIGN_RULES['drives'],
    'most failures': CAMPAIGN_RULES['most failures'],
    'difference': CAMPAIGN_RULES['difference'],
    'difference interval': CAMPAIGN_RULES['difference interval'],
    'not dominated': 'No other controller is at least as good in each of these and better in one: '
    f'{COMPARED[0]}, median over all cases of '
    f'{", ".join(METRICS[name].symbol for name in MAIN)}.',
    'median over all cases': 'A run that did not engage counts as worse than any value, so that '
    'to fail in hard cases is no advantage. A dash: half of the runs or more did not engage.',
}
"""Definitions by term."""


def states_text(evaluation: Evaluation) -> str:
    """Return the numbers of runs in states other than engaged."""
    return ', '.join(
        f'{found["runs"]} {state_text(state)}'
        for state, found in evaluation['states'].items()
        if state != 'engaged'
    )


def gap_name(name: str) -> str:
    """Return the name of a gap in texts."""
    return 'share of successes' if name == SUCCESS else METRICS[name].symbol


def notes_of(result: Result) -> Iterator[str]:
    """Yield how the cases differ from those of a plain benchmark, a line each."""
    if result['judge_seed'] is not None:
        yield f'the held-out cases are those of a judge: --seed {result["judge_seed"]}'
    if result['cases']['quick']:
        yield 'a quick benchmark: a tenth of the cases'


def warnings_of(result: Result) -> Iterator[str]:
    """Yield what to know of the rows and of controllers before reading the tables, a line each."""
    if result['cases']['other_code']:
        yield result['cases']['other_code']
    for judged in result['controllers']:
        yield from _warnings(judged)


def _warnings(judged: JudgedResult) -> Iterator[str]:
    name = judged['controller']
    if judged['error']:
        yield f'{name}: not judged: {judged["error"]}'
    for part, evaluations in (
        ('development', judged['development']),
        ('held-out', judged['held_out']),
    ):
        if evaluations and (invalid := evaluations[0]['states'].get('invalid')):
            reason = evaluations[0]['reasons'][0]['reason']
            yield f'{name}: {invalid["runs"]} {part} runs are invalid, such as: {reason}'
    worse = [gap for gap in judged['gaps'] or () if gap['differs'] and (gap['worse'] or 0.0) > 0.5]
    if worse:
        figures = ', '.join(gap_name(gap['name']) for gap in worse)
        yield f'{name}: worse on held-out cases, beyond chance: {figures}'
