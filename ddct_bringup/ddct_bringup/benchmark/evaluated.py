# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities that a benchmark evaluates: the five figures, then the others of a campaign."""

from collections.abc import Mapping

import numpy as np

from ddct_bringup.benchmark.statistics.case_figures import FIGURES
from ddct_bringup.campaign_report.evaluated_quantities import QUANTITIES
from ddct_bringup.campaign_report.results import is_number

Columns = Mapping[str, np.ndarray]
"""Columns of one controller by name, (cases,) each."""
MAIN = tuple(each.name for each in FIGURES)
"""Keys of the five figures."""
EVALUATED = {each.key: each for each in (*(figure.quantity for figure in FIGURES), *QUANTITIES)}
"""Every quantity by its key."""
_SUMS = {each.name: each for each in FIGURES if len(each.columns) > 1}


def values_of(columns: Columns, key: str) -> np.ndarray | None:
    """Return the values of a quantity, (cases,); None of rows without it."""
    if key in _SUMS:
        return _SUMS[key].values_in(columns)
    values = columns.get(key)
    return values if is_number(values) else None
