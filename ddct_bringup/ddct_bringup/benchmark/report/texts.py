# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Definitions and texts of a benchmark for its page and the terminal."""

from collections.abc import Iterable, Iterator, Sequence

from ddct_bringup.benchmark.result_types import JudgedResult, Result
from ddct_bringup.campaign_report.texts import RULES as CAMPAIGN_RULES
from ddct_bringup.campaign_report.texts import state_text
from ddct_bringup.documents.document import Terms
from ddct_bringup.evaluation.case_figures import FIGURES, LEVEL
from ddct_bringup.evaluation.dominance import RELATIVE_DIFFERENCE, PairedComparison
from ddct_bringup.evaluation.held_out_gaps import METHOD as GAP_METHOD
from ddct_bringup.evaluation.quantities import QUANTITIES
from ddct_bringup.evaluation.share import CONFIDENCE, METHOD
from ddct_bringup.evaluation.summary import GroupSummary, Summary
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.program.table import PURE

NO_VALUE = 'no success has a value'
"""Reason of a dash."""
_DIFFERENCES = ', '.join(
    f'{figure.quantity.symbol} {figure.least_difference:g}'
    + ('' if figure.quantity.unit == PURE else f' {figure.quantity.unit}')
    for figure in FIGURES
)
RULES = {
    'development': 'Cases that are fixed in a release, and that anyone may tune a controller on.',
    'held out': 'Cases of the same kinds whose seed follows from the digests of controller and '
    'release: nobody can tune a controller on its own. A judge may give another seed.',
    'success': f'The run is valid, and its state is {ENGAGED}. All other runs are failures.',
    'interval': f'{METHOD}, {100.0 * CONFIDENCE:g} %.',
    'gap': f'Both sets are samples of the same cases. {GAP_METHOD}, of ranks within scenarios, a '
    f'failure worse than any success; p is at most {LEVEL:g} over the number of figures where '
    'held-out runs are worse beyond chance. A controller that remembers the development cases '
    'shows here.',
    'P50, P95, worst': 'Of the successes that have a value; the worst is the largest. Failures '
    'have no place among them: their share is in the first table.',
    'explained': CAMPAIGN_RULES['explained'],
    'drives': CAMPAIGN_RULES['drives'],
    'most failures': CAMPAIGN_RULES['most failures'],
    'difference': CAMPAIGN_RULES['difference'],
    'difference interval': CAMPAIGN_RULES['difference interval'],
    'better, worse': 'In a case a controller is better if its figure is less by more than '
    f'{100.0 * RELATIVE_DIFFERENCE:g} % and by more than: {_DIFFERENCES}. A failure is worse than '
    'any success, and two failures tie. A figure that is null by the case leaves that case out '
    'for both.',
    'dominates': 'One figure is better beyond chance, by the one-sided sign test of better and '
    f'worse cases at {LEVEL:g} over the figures and over all ordered pairs of controllers. No '
    f'figure is worse: neither at {LEVEL:g} of its own nor in its median difference. If all '
    'controllers were equal, any of them would be dominated in at most '
    f'{100.0 * LEVEL:g} % of benchmarks.',
}
"""Definitions by term."""


def terms(*names: str) -> Terms:
    """Return the definitions of terms."""
    return Terms({name: RULES[name] for name in names})


def states_text(group: GroupSummary) -> str:
    """Return the numbers of runs in states other than engaged, invalid ones last."""
    counts = {state: found.count for state, found in group.states.items() if state != ENGAGED}
    if group.invalid:
        counts[INVALID] = group.invalid
    return ', '.join(f'{count} {state_text(state)}' for state, count in counts.items())


def figure_name(key: str) -> str:
    """Return the symbol of a figure in texts."""
    return QUANTITIES[key].symbol


def left_out_text(comparisons: Iterable[PairedComparison]) -> str:
    """Return by figure the largest number of cases that any of the comparisons leaves out."""
    left_out: dict[str, int] = {}
    for comparison in comparisons:
        for key, figure in comparison.figures.items():
            left_out[key] = max(left_out.get(key, 0), figure.left_out)
    return ', '.join(f'{figure_name(key)} {cases}' for key, cases in left_out.items())


def dominance_lines(development: Summary, name: str) -> Iterator[str]:
    """Yield sentences on which controllers dominate a judged one, and which it dominates."""
    compared = {
        pair.second: pair.comparison for pair in development.pairs_of(name) if pair.comparison
    }
    if not compared:
        return
    dominated_by = development.group(name).dominated_by or ()
    dominated = [
        other for other in compared if name in (development.group(other).dominated_by or ())
    ]
    for chosen, one, none in (
        (dominated_by, f'{name} is dominated by', f'no controller dominates {name}'),
        (dominated, f'{name} dominates', f'{name} dominates no controller'),
    ):
        found = f'{one} {", ".join(chosen)}' if chosen else none
        yield f'{found}: {_cases_text([compared[other] for other in chosen or compared])}'


def _cases_text(comparisons: Sequence[PairedComparison]) -> str:
    most = ' at most' if len(comparisons) > 1 else ''
    return f'{comparisons[0].cases} cases, left out{most}: {left_out_text(comparisons)}'


def notes_of(result: Result) -> Iterator[str]:
    """Yield how the cases differ from those of a plain benchmark, a line each."""
    if result.judge_seed is not None:
        yield f'the held-out cases are those of a judge: --seed {result.judge_seed}'
    if result.cases.car:
        yield (
            f'the car of all cases is {result.cases.car}; the release has no rows of it, so the '
            'controllers beside the judged ones ran in the development cases too'
        )
    for name, reason in result.cases.left_out.items():
        yield f'{name} is left out, since the car cannot drive it: {reason}'
    if result.cases.quick:
        yield 'a quick benchmark: a tenth of the cases, too few to say who dominates whom'


def warnings_of(result: Result) -> Iterator[str]:
    """Yield what to know of the rows and of controllers before reading the tables, a line each."""
    if result.cases.other_code:
        yield result.cases.other_code
    for judged in result.controllers:
        yield from _warnings(judged, result.development)


def _warnings(judged: JudgedResult, development: Summary | None) -> Iterator[str]:
    name = judged.controller
    if judged.error:
        yield f'{name}: not judged: {judged.error}'
    if not (judged.held_out and development):
        return
    for part, group in (
        ('development', development.group(name)),
        ('held-out', judged.held_out.group(name)),
    ):
        if group.invalid:
            reason = group.reasons[0].reason
            yield f'{name}: {group.invalid} {part} runs are invalid, such as: {reason}'
    worse = [figure_name(gap.name) for gap in judged.gaps or () if gap.differs]
    if worse:
        yield f'{name}: worse on held-out cases, beyond chance: {", ".join(worse)}'
