# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Definitions and texts of a summary for the page and the terminal."""

import shlex
from collections.abc import Iterator

from ddct_bringup.documents.document import Terms
from ddct_bringup.documents.page_parts import value_text
from ddct_bringup.evaluation.attribution import FEWEST
from ddct_bringup.evaluation.boundaries import BoundarySide
from ddct_bringup.evaluation.parts import MOST_PARTS, KeyPart
from ddct_bringup.evaluation.share import CONFIDENCE, METHOD
from ddct_bringup.evaluation.spread import ONE_IN
from ddct_bringup.evaluation.summary import GroupSummary, OtherVersion, PairSummary, Summary
from ddct_bringup.verdict.state import ENGAGED

RULES = {
    'failed': 'The run is valid, and its state is not engaged. A metric beyond its limit is no '
    'failed engagement.',
    'invalid': 'The run does not count: it is neither engaged nor failed, and stands apart.',
    'share': 'Failed runs among the valid ones. Beside it are the runs of each other state.',
    'interval': f'{METHOD}, {100.0 * CONFIDENCE:g} %, of runs that are a random sample. Invalid '
    'runs count as engaged at its lower end and as failed at its upper end. Runs on a grid are no '
    'sample and have none.',
    'nominal': 'The value of the scenario. A line over one key starts at the value of the grid '
    'that is nearest to it. A dash: the scenario gives no value, and 0 stands for it.',
    'boundary': 'From the start of the line to each side: the last value up to which no run '
    'failed and all are valid, and the first value at which a run failed. The other keys of '
    'the grid stay at the values in the last column.',
    'explained': 'The main effect of a key: the part of the variance of failure that the key '
    f'explains by itself, 0 to 1, over at most {MOST_PARTS} parts of its range, or over its '
    'names, such as those of scenarios. Keys that act together only are not found by it.',
    'drives': 'Beyond chance: the p-value, by a permutation test and corrected for the number of '
    f'keys (Holm), is at most {1.0 - CONFIDENCE:.2g}. Fewer than {FEWEST} failed runs say nothing '
    'of keys.',
    'most failures': 'The part of the range with the largest share of failed runs, or the names '
    'that fail, as one group: the one that differs most from the others. It is chosen after the '
    'runs, so its share is larger than that of new runs; p and the interval are of all parts.',
    'quantiles': 'P5, P50 and P95 of the engaged runs that have a value, with their signs. Failed '
    'runs have no place among them: their share is in the first table. On a grid these are '
    'quantiles over its points, not chances.',
    'CVaR': 'Conditional value at risk of the engaged runs: the mean magnitude of their worst 5 % '
    f'(n/20 of n; a part of a run counts as that part). Fewer than {ONE_IN} runs have none.',
    'worst': 'The largest magnitude, with its sign: of the engaged runs, and beside it of all '
    'valid runs where a failed one has a larger one.',
    'difference': 'Magnitude of the first controller less that of the second in the same case, '
    'only over the cases in which both engaged. Below zero the first one is better.',
    'difference interval': f'Of the median, by the sign test, {100.0 * CONFIDENCE:g} %. '
    'It does not cover zero where one of the two is better in the middle.',
}
"""Definitions by term."""


def terms(*names: str) -> Terms:
    """Return the definitions of terms."""
    return Terms({name: RULES[name] for name in names})


def replay_command(folder: str, index: int | str) -> str:
    """Return the command that makes the bag of one row; a page has the folder that it is in."""
    out = f'../replay-{index}' if folder == '.' else f'replay-{index}'
    return shlex.join(['ddct', 'campaign', 'replay', folder, '--index', str(index), '--out', out])


def states_text(group: GroupSummary) -> str:
    """Return the numbers of runs in states other than engaged, with the shares of a sample."""
    return ', '.join(
        f'{found.count} {state_text(state)}'
        + (f' ({found.interval_text})' if found.low is not None else '')
        for state, found in group.states.items()
        if state != ENGAGED
    )


def boundary_text(side: BoundarySide) -> str:
    """Return the first failure on one side of a line."""
    if side.first_failure is None or side.failed is None:
        return 'no run on this side' if side.last_good is None else 'none in the range'
    several = ''
    if side.failed.of > 1:
        several = f', {side.failed.count} of {side.failed.of} runs'
    first = _apart(side.first_failure, side.last_good)
    return f'{first} ({state_text(side.state)}, run {side.index}{several})'


def good_text(side: BoundarySide) -> str:
    """Return the last good value on one side of a line, and the number of invalid runs."""
    invalid = f', {side.invalid} invalid on the way' if side.invalid else ''
    if side.last_good is None:
        return f'no good value before{invalid}' if side.first_failure is not None else ''
    return f'good to {_apart(side.last_good, side.first_failure)}{invalid}'


def _apart(value: float, other: float | None) -> str:
    """Return a value with enough digits to differ from another one."""
    if other is None or value_text(value) != value_text(other):
        return value_text(value)
    return next(
        (
            f'{value:.{digits}g}'
            for digits in range(5, 17)
            if f'{value:.{digits}g}' != f'{other:.{digits}g}'
        ),
        repr(value),
    )


def range_text(low: float, high: float) -> str:
    """Return the ends of an interval or a range."""
    return value_text(low) if low == high else f'{value_text(low)} to {value_text(high)}'


def where_text(part: KeyPart) -> str:
    """Return a part of a key's values: the ends of a range, or names."""
    if part.low is None or part.high is None:
        return ', '.join(part.names)
    return range_text(part.low, part.high)


def p_text(p_value: float) -> str:
    """Return a p-value."""
    return '< 0.001' if p_value < 0.001 else f'{p_value:.3f}'


def part_text(part: KeyPart) -> str:
    """Return the part of a key's values in which failure is most frequent."""
    return f'{part.failed.count} of {part.failed.of} at {where_text(part)}'


def state_text(state: str | None) -> str:
    """Return the name of a state as text, empty without one."""
    return (state or '').replace('_', ' ')


def joint_outcomes_text(pair: PairSummary) -> str:
    """Return the number of cases in which both, one or none of two controllers engaged."""
    found = pair.outcomes
    return (
        f'{found.both} of {found.cases} cases (only {pair.first} {found.first_only}, '
        f'only {pair.second} {found.second_only}, neither {found.neither})'
    )


def notes_of(summary: Summary) -> list[str]:
    """Return of which groups no keys that drive failure are named, and why, a line each."""
    return [
        f'{group.label}: {group.causes.too_few}'
        for group in summary.groups
        if group.causes and group.causes.too_few
    ]


def other_version_lines(other: OtherVersion) -> Iterator[str]:
    """Yield how results of another version differ from those of this one."""
    if other.absent:
        yield f'without {", ".join(other.absent)}'
    if other.unknown:
        yield f'also with {", ".join(other.unknown)}: in --csv only'
    if other.no_nominal:
        yield f'the nominal values are not known: {other.no_nominal}'
