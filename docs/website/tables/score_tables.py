# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the figures, further metrics and limits by which runs are judged."""

from collections.abc import Iterable

from ddct_bringup.metrics.catalogue import FIGURES, OTHERS
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.of_car import OF_CAR
from ddct_plant.program.table import TextTable

_HEADERS = ('key', 'in tables', 'unit', 'what it is', 'no value when')


def score_tables() -> dict[str, TextTable]:
    """Return the tables by name."""
    limits = [
        (
            f'`{limit.metric}`',
            OF_CAR if limit.value is None else f'{limit.value:g} {limit.unit}',
            'all' if limit.applies_to is None else ', '.join(f'`{n}`' for n in limit.applies_to),
            limit.source,
        )
        for limit in packaged_limits().limits
    ]
    return {
        'figures': _table_of(FIGURES),
        'metrics': _table_of(OTHERS),
        'limits': TextTable('', ('metric', 'limit', 'holds for', 'source'), limits),
    }


def _table_of(metrics: Iterable[Metric]) -> TextTable:
    rows = [
        (f'`{each.key}`', each.symbol, each.unit, each.meaning, each.undefined) for each in metrics
    ]
    return TextTable('', _HEADERS, rows)
