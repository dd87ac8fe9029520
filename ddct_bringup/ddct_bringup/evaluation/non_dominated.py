# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Points that no other one betters: fronts of runs and of trials. Less is better in all values."""

from collections.abc import Hashable, Mapping, Sequence
from typing import TypeVar

Key = TypeVar('Key', bound=Hashable)


def dominates(first: Sequence[float], second: Sequence[float]) -> bool:
    """Return whether the first point is nowhere above the second one, and below in one value."""
    pairs = list(zip(first, second, strict=True))
    return all(ours <= theirs for ours, theirs in pairs) and any(a < b for a, b in pairs)


def non_dominated(points: Mapping[Key, Sequence[float]]) -> list[Key]:
    """
    Return the keys of the points that no other one dominates, in their order.

    Equal points are all kept or all dropped.
    """
    return [
        key
        for key, point in points.items()
        if not any(dominates(other, point) for other in points.values())
    ]
