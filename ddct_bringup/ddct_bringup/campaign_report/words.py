"""How page and terminal say what the summary holds: definitions, words, and tables."""

import shlex
from collections.abc import Sequence

from ddct_bringup.campaign_report.outcome import CONFIDENCE, METHOD
from ddct_bringup.campaign_report.summary import Summary
from ddct_bringup.report.page_parts import value_text
from ddct_bringup.verdict.metric_figures import METRICS
from ddct_plant.program.table import UNDEFINED, Table, text_or_dash

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


def share_text(failed: Summary) -> str:
    """Return the share of failed engagements in percent."""
    return UNDEFINED if failed['share'] is None else f'{100.0 * failed["share"]:.1f} %'


def interval_text(failed: Summary) -> str:
    """Return the ends of its interval, or a dash."""
    if failed['interval'] is None:
        return UNDEFINED
    lower, upper = (100.0 * end for end in failed['interval'])
    return f'{lower:.1f} to {upper:.1f} %'


def states_text(failed: Summary) -> str:
    """Return how many runs are in which state, those that are not engaged."""
    states = failed['states'].items()
    return ', '.join(f'{count} {spoken(name)}' for name, count in states if name != 'engaged')


def way_text(way: Summary) -> str:
    """Return where engagement fails first on a way out."""
    held, first = way['held_to'], way['first_failure']
    if first is None:
        return 'no run on this side' if held is None else 'none in the range'
    several = f', {way["lost"]} of {way["runs"]} runs' if way['runs'] > 1 else ''
    return f'{value_text(first)} ({spoken(way["state"])}, run {way["index"]}{several})'


def held_text(way: Summary) -> str:
    """Return up to which value it held."""
    if way['held_to'] is None:
        return 'nothing held' if way['first_failure'] is not None else ''
    return f'held to {value_text(way["held_to"])}'


def spoken(state: str) -> str:
    """Return the name of a state in words."""
    return state.replace('_', ' ')


def summary_tables(summary: Summary) -> list[Table]:
    """Return how often, where failure begins, and how badly."""
    return [_failed(summary), *_first_failures(summary), _quantities(summary)]


def label_of(group: Summary) -> str:
    """Return what a table calls a group of a summary."""
    return ', '.join([group['controller'], *group['varied'].values()])


def _failed(summary: Summary) -> Table:
    rows = [
        (
            label_of(group),
            share_text(failed),
            interval_text(failed),
            *(str(failed[name]) for name in ('runs', 'engaged', 'failed', 'invalid')),
            states_text(failed) or UNDEFINED,
        )
        for group in summary['groups']
        for failed in [group['failed']]
    ]
    headers = 'controller', 'failed', '95 % interval', 'runs', 'engaged', 'failed', 'invalid', 'as'
    return Table('How often engagement fails', headers, rows, numbers=[False, *[True] * 6])


def _first_failures(summary: Summary) -> list[Table]:
    rows = [
        (
            found['key'],
            label_of(group),
            UNDEFINED if found['nominal'] is None else value_text(found['nominal']),
            *(text(found[side]) for side in ('below', 'above') for text in (way_text, held_text)),
        )
        for place in range(len(summary['groups'][0]['first_failures']))
        for group in summary['groups']
        for found in [group['first_failures'][place]]
    ]
    headers = 'varied', 'controller', 'nominal', 'fails below at', '', 'fails above at', ''
    return [Table('Where failure begins', headers, rows)] if rows else []


def _quantities(summary: Summary) -> Table:
    """Return the metrics; the page has the other criteria too."""
    rows = [
        _quantity(label_of(group), group['quantities'][place])
        for place in range(len(summary['groups'][0]['quantities']))
        for group in summary['groups']
        if group['quantities'][place]['name'] in METRICS
    ]
    headers = 'quantity', 'controller', 'median', 'CVaR', 'worst engaged', 'run', 'worst', 'run'
    return Table('How bad it becomes', headers, rows, numbers=[False, False, *[True] * 5])


def _quantity(label: str, found: Summary) -> Sequence[str]:
    figure = METRICS[found['name']]
    worst = found['worst']
    return (
        figure.heading,
        label,
        *(text_or_dash(found[name], figure.form) for name in ('median', 'cvar')),
        text_or_dash(found['worst_engaged']['value'], figure.form),
        text_or_dash(found['worst_engaged']['index'], 'd'),
        text_or_dash(worst['value'], figure.form),
        UNDEFINED if worst['index'] is None else f'{worst["index"]} ({spoken(worst["state"])})',
    )
