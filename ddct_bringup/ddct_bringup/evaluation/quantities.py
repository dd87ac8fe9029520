# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities that are evaluated over many runs: figures and metrics of which less is better."""

from collections.abc import Mapping

import numpy as np

from ddct_bringup.evaluation.case_figures import FIGURES
from ddct_bringup.metrics.catalogue import REPEATABLE

_SUMS = {each.name: each for each in FIGURES if len(each.columns) > 1}
OF_RUNS = {each.key: each for each in REPEATABLE if each.smaller_is_better}
"""Figures and further metrics that have a column of rows, by its name."""
QUANTITIES = {**{name: each.quantity for name, each in _SUMS.items()}, **OF_RUNS}
"""All quantities by key; for each a smaller magnitude is better."""
MAIN = tuple(each.name for each in FIGURES)
"""Keys of the five figures by which controllers are compared."""


def with_sums(columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the columns of runs, (n,) each, with the figures that are sums of them."""
    sums = {
        name: figure.values_in(columns)
        for name, figure in _SUMS.items()
        if all(is_number(columns.get(each)) for each in figure.columns)
    }
    return {**columns, **sums}


def is_number(column: np.ndarray | None) -> bool:
    """Return whether there is a column of numbers; booleans are none."""
    return column is not None and bool(np.issubdtype(column.dtype, np.number))
