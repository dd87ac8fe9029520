"""The summary of a campaign as tables for the terminal."""

from collections.abc import Sequence

from ddct_bringup.campaign_report.summary import Summary
from ddct_bringup.campaign_report.words import (
    held_text,
    interval_text,
    share_text,
    spoken,
    states_text,
    way_text,
)
from ddct_bringup.report.tables.verdict_table import value_text
from ddct_bringup.verdict.metric_figures import METRICS
from ddct_plant.program.table import UNDEFINED, Table, text_or_dash


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
