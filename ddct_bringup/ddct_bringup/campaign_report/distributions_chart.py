# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Chart of a campaign: distributions of the main metrics, a curve for each controller."""

import numpy as np

from ddct_bringup.campaign_report.tables import MAIN
from ddct_bringup.documents.chart import Chart, ChartAxis, Line, Panel
from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.documents.palette import LineLook, looks
from ddct_bringup.evaluation.grouped_rows import Group, GroupedRows
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import Quantity

_ACROSS = 3
_MOST_STEPS = 500
"""Largest number of steps of a curve: more cannot be distinguished."""


def distributions_chart(results: GroupedRows, scenario: str) -> Chart:
    """
    Return the chart: a panel for each main metric, a curve for each controller.

    A curve is the share of the valid runs that engaged with at most this value. It ends at the
    share of the runs that engaged and have a value; the rest up to 1 failed, or has no value.
    Raise DdctError where there is nothing to draw.
    """
    if why := nothing_drawn(results):
        raise DdctError(f'{why}: nothing to draw')
    metrics = _metrics(results)
    found = looks(len(results.groups))
    panels = tuple(
        Panel(
            tuple(
                _curve(results, group, quantity, look)
                for group, look in zip(results.groups, found, strict=True)
            ),
            ChartAxis(', '.join(filter(None, (quantity.symbol, unit_text(quantity.unit))))),
            ChartAxis('share of valid runs', (0.0, 1.02)),
        )
        for quantity in metrics
    )
    return Chart(_title(results, scenario), panels, _conditions(results), _ACROSS, same_y=True)


def nothing_drawn(results: GroupedRows) -> str:
    """Return why there is nothing to draw, empty where there is something."""
    if (results.outcomes == INVALID).all():
        return 'no run is valid'
    return '' if _metrics(results) else 'no run has a value of a main metric'


def _metrics(results: GroupedRows) -> list[Quantity]:
    there = {each.key: each for each in results.quantities}
    return [there[key] for key in MAIN if key in there]


def _title(results: GroupedRows, scenario: str) -> str:
    varied = ', '.join([*results.by.grid, *results.by.random])
    return f'Scenario {scenario}: {results.rows} runs over {varied}'


def _conditions(results: GroupedRows) -> str:
    kind = 'random samples' if results.by.random else 'points of a grid, not chances'
    return f'share of the valid runs that engaged with at most this value ({kind})'


def _curve(results: GroupedRows, group: Group, quantity: Quantity, look: LineLook) -> Line:
    """Return one curve; that of a controller without an engaged run is empty."""
    outcomes = results.outcomes[group.rows]
    values = results.columns[quantity.key][group.rows]
    taken = np.sort(values[(outcomes == ENGAGED) & ~np.isnan(values)])
    valid = max(int(np.sum(outcomes != INVALID)), 1)
    shares = np.arange(1, len(taken) + 1) / valid
    if len(taken) > _MOST_STEPS:
        kept = np.unique(np.linspace(0, len(taken) - 1, _MOST_STEPS).round().astype(int))
        taken, shares = taken[kept], shares[kept]
    if len(taken):
        taken, shares = np.append(taken[:1], taken), np.append([0.0], shares)
    return Line(taken, shares, look, group.label, steps=True)
