# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of metrics, criteria and limits with the names of the programs."""

from ddct_bringup.metrics.catalogue import CRITERIA, METRICS
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.program.table import Table

_HEADERS = ('unit', 'what it is', 'no value when')


def score_tables() -> dict[str, Table]:
    """Return the tables by name."""
    metrics = [
        (f'`{each.key}`', each.symbol, each.unit, each.meaning, each.undefined)
        for each in METRICS.values()
    ]
    criteria = [(f'`{each.key}`', each.unit, each.meaning, each.undefined) for each in CRITERIA]
    limits = [
        (
            f'`{limit.criterion}`',
            f'{limit.value:g} {limit.unit}',
            'all' if limit.applies_to is None else ', '.join(f'`{n}`' for n in limit.applies_to),
            limit.source,
        )
        for limit in packaged_limits().limits
    ]
    return {
        'metrics': Table('Metrics', ('key', 'in tables', *_HEADERS), metrics),
        'criteria': Table('Criteria', ('name', *_HEADERS), criteria),
        'limits': Table('Limits', ('criterion', 'limit', 'holds for', 'source'), limits),
    }
