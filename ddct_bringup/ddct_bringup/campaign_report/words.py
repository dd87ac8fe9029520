"""How page and terminal say what the summary holds."""

import shlex
from typing import Any

from ddct_bringup.campaign_report.outcome import CONFIDENCE, METHOD
from ddct_bringup.report.tables.verdict_table import value_text
from ddct_plant.program.table import UNDEFINED

RULES = {
    'failed': 'The verdict of a valid run has another state than engaged. A criterion beyond its '
    'limit is no failed engagement.',
    'invalid': 'The run does not count: it is neither engaged nor failed, and stands apart.',
    'share': 'Failed runs among the valid ones.',
    'interval': f'{METHOD}, {100.0 * CONFIDENCE:g} %, of runs that are a random sample. Invalid '
    'runs count as engaged at its lower end and as failed at its upper end. Runs on a grid are no '
    'sample and have none.',
    'nominal': 'The value of the scenario, where the way to either side begins. "from": it begins '
    'at the nearest value of the grid. A dash: the scenario gives no value, and 0 stands for it.',
    'first failure': 'The first value, from the nominal one outward, at which not every run is '
    'engaged; other numbers of the grid are at the value nearest to nominal. Of random samples it '
    'is the nearest one that is not engaged, whatever else was drawn with it.',
    'held to': 'The last value before it: there and on the way every run is engaged.',
    'magnitude': 'All figures are magnitudes, of which less is better.',
    'CVaR': 'Conditional value at risk: the mean of the worst 5 % of the runs (n/20 of n; a part '
    'of a run counts as that part). On a grid these are its points, not chances.',
    'rank': 'A run that is not engaged or has no value ranks behind every value. Where such a run '
    'is among the worst 5 %, CVaR has no value; where it reaches the middle, the median has none.',
    'worst': 'The largest value of the engaged runs, and beside it of all valid runs where a '
    'failed one has a larger one.',
}
"""Definitions by what they define."""


def replay_command(folder: str, index: int | str) -> str:
    """Return the command that makes the bag of one row."""
    return f'ddct campaign replay {shlex.quote(folder)} --index {index} --out replay-{index}'


def share_text(failed: dict[str, Any]) -> str:
    """Return the share of failed engagements in percent."""
    return UNDEFINED if failed['share'] is None else f'{100.0 * failed["share"]:.1f} %'


def interval_text(failed: dict[str, Any]) -> str:
    """Return the ends of its interval, or a dash."""
    if failed['interval'] is None:
        return UNDEFINED
    lower, upper = (100.0 * end for end in failed['interval'])
    return f'{lower:.1f} to {upper:.1f} %'


def states_text(failed: dict[str, Any]) -> str:
    """Return how many runs are in which state, those that are not engaged."""
    states = failed['states'].items()
    return ', '.join(f'{count} {spoken(name)}' for name, count in states if name != 'engaged')


def way_text(way: dict[str, Any]) -> str:
    """Return where engagement fails first on a way out."""
    held, first = way['held_to'], way['first_failure']
    if first is None:
        return 'no run on this side' if held is None else 'none in the range'
    several = f', {way["lost"]} of {way["runs"]} runs' if way['runs'] > 1 else ''
    return f'{value_text(first)} ({spoken(way["state"])}, run {way["index"]}{several})'


def held_text(way: dict[str, Any]) -> str:
    """Return up to which value it held."""
    if way['held_to'] is None:
        return 'nothing held' if way['first_failure'] is not None else ''
    return f'held to {value_text(way["held_to"])}'


def spoken(state: str) -> str:
    """Return the name of a state in words."""
    return state.replace('_', ' ')
