# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of a campaign, made by hand."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ddct_bringup.campaign_report.results import Results


def made_results(
    states: Sequence[str],
    varied: Mapping[str, Sequence[Any]] | None = None,
    quantities: Mapping[str, Sequence[float]] | None = None,
    *,
    controllers: Sequence[str] | None = None,
    random: Sequence[str] = (),
    nominal: Mapping[str, float] | None = None,
) -> Results:
    """Return results with a run per state; what is varied and not random is of the grid."""
    runs = len(states)
    varied = dict(varied or {})
    columns = {
        'index': np.arange(runs),
        'controller': np.array(controllers or ['pi'] * runs, dtype=object),
        'valid': np.array([state != 'invalid' for state in states]),
        'reason': np.array(
            ['it broke' if state == 'invalid' else '' for state in states], dtype=object
        ),
        'state': np.array(states, dtype=object),
        **{key: _column(values) for key, values in varied.items()},
        **{key: np.array(values, dtype=float) for key, values in (quantities or {}).items()},
    }
    grid = [key for key in varied if key not in random]
    return Results(columns, grid, list(random), dict(nominal or {}))


def _column(values: Sequence[Any]) -> np.ndarray:
    return np.array(values, dtype=object if isinstance(values[0], str) else None)
