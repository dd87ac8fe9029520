# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Parts of the values of a key, each with its runs: ranges of a number, or single names.

The values of a name, such as those of a scenario, have no order: each is a part of its own.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.evaluation.share import Share

MOST_PARTS = 10
"""Largest number of parts of a number's range."""


@dataclass(frozen=True)
class KeyPart:
    """Runs in one part of a key's values: a range of numbers, or names."""

    failed: Share
    """Failed runs among those in the part."""
    low: float | None = None
    """Smallest value drawn in the part; None for names."""
    high: float | None = None
    """Largest value drawn in the part."""
    names: tuple[str, ...] = ()
    """Names, in the order of the first run of each; empty for a range."""

    @property
    def share(self) -> float:
        """Share of the failed runs, 0 to 1."""
        return self.failed.count / self.failed.of


def parts_of(values: np.ndarray, failed: np.ndarray, runs_in_part: int) -> tuple[KeyPart, ...]:
    """
    Return the parts of a key's values: ranges of numbers, or one for each name.

    `values` are the (n,) values of the runs; those that are no numbers, such as texts and
    booleans, are names. `failed` is (n,). See `places_in_range` for the number of ranges.
    """
    if not np.issubdtype(values.dtype, np.number):
        names = values.astype(str)
        return tuple(
            KeyPart(_failed(failed[names == name]), names=(name,))
            for name in dict.fromkeys(names.tolist())
        )
    places = places_in_range(values, runs_in_part)
    chosen = [places == each for each in range(int(places.max()) + 1)]
    return tuple(
        KeyPart(_failed(failed[rows]), float(values[rows].min()), float(values[rows].max()))
        for rows in chosen
    )


def _failed(failed: np.ndarray) -> Share:
    return Share(int(np.sum(failed)), len(failed))


def places_in_range(values: np.ndarray, runs_in_part: int) -> np.ndarray:
    """
    Return the number of the part in which each of (n,) numbers is, from 0 for the smallest ones.

    There is a part for each value if there are few, else parts with equally many runs: at most
    `MOST_PARTS`, and at least `runs_in_part` runs in each where there are so many.
    """
    count = min(MOST_PARTS, max(2, len(values) // runs_in_part))
    edges = np.unique(values)
    if len(edges) > count:
        edges = np.unique(np.quantile(values, np.arange(count) / count))
    return np.unique(np.searchsorted(edges, values, side='right'), return_inverse=True)[1]


def worst_of(parts: Sequence[KeyPart]) -> KeyPart:
    """
    Return the part with the largest share of failed runs: a range, the first of equals, or names.

    The names are those that fail, as one group: of all divisions of the names into two groups it
    has the largest variance of failure between them. One of those has a group that no name
    outside fails more often than a name inside (Fisher 1958), so that few are compared.
    """
    names = [part for part in parts if part.names]
    if not names:
        return max(parts, key=lambda part: part.share)
    by_share = sorted(names, key=lambda part: -part.share)
    runs = np.cumsum([part.failed.of for part in by_share])
    failed = np.cumsum([part.failed.count for part in by_share])
    inside, mean = runs[:-1], failed[-1] / runs[-1]
    between = (failed[:-1] - mean * inside) ** 2 / (inside * (runs[-1] - inside))
    count = int(np.argmax(between)) + 1 if len(names) > 1 else 1
    chosen = by_share[:count]
    return KeyPart(
        Share(int(failed[count - 1]), int(runs[count - 1])),
        names=tuple(name for part in names if part in chosen for name in part.names),
    )
