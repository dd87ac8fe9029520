# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of a campaign, made by hand."""

from collections.abc import Mapping, Sequence
from typing import Any

import pyarrow as pa

from ddct_bringup.evaluation.grouped_rows import By, GroupedRows


def made_results(
    states: Sequence[str],
    varied: Mapping[str, Sequence[Any]] | None = None,
    quantities: Mapping[str, Sequence[float]] | None = None,
    *,
    controllers: Sequence[str] | None = None,
    random: Sequence[str] = (),
    nominal: Mapping[str, float] | None = None,
) -> GroupedRows:
    """Return rows with a run per state; what is varied and not random is of the grid."""
    runs = len(states)
    varied = dict(varied or {})
    table = pa.table(
        {
            'index': range(runs),
            'controller': controllers or ['pi'] * runs,
            'valid': [state != 'invalid' for state in states],
            'reason': ['it broke' if state == 'invalid' else '' for state in states],
            'state': states,
            **varied,
            **{key: [*map(float, values)] for key, values in (quantities or {}).items()},
        }
    )
    grid = tuple(key for key in varied if key not in random)
    return GroupedRows(table, By(grid, tuple(random), dict(nominal or {})))
