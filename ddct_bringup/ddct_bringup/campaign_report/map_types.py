# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Types of the JSON content from which the script of the page draws the maps."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class MapScale:
    """Quantity of the maps, and the ends of its colour scale by magnitude."""

    key: str
    title: str
    """Symbol and unit."""
    low: float
    high: float


@dataclass(frozen=True)
class MapPanel:
    """Cells or points of one group, as columns of equal length."""

    at: list[list[float]]
    """Coordinates, a column for each varied number."""
    runs: list[int]
    failed: list[int]
    invalid: list[int]
    intervals: list[tuple[float | None, float | None]] | None
    """Intervals of the share of failed runs; None where no place has several runs."""
    state: list[str]
    """State that marks the place."""
    index: list[int]
    """Index of the run that marks the place."""
    values: dict[str, list[float | None]]
    """Value of largest magnitude by quantity; None where all runs lack one."""
    rows: dict[str, list[int | None]] | None
    """Index of the run with this value; None where no place has several runs."""


@dataclass(frozen=True)
class CellMap:
    """Map over the grid."""

    keys: list[str]
    cells: Literal[True]
    others: dict[str, float]
    """Values of the grid's other numbers by key."""
    extent: str
    panels: list[MapPanel]


@dataclass(frozen=True)
class PointMap:
    """Map of random samples, whose points are part of those of all maps."""

    keys: list[str]
    cells: Literal[False]
    others: dict[str, float]
    extent: str
    panels: list[list[int] | None]
    """Positions of the points of each group; None for all."""


@dataclass(frozen=True)
class CampaignMaps:
    """Maps of a campaign."""

    quantities: list[MapScale]
    groups: list[str]
    points: list[MapPanel] | None
    """Points of each group; None without a map of samples."""
    numbers: list[str]
    """Keys of the coordinates of `points`."""
    maps: list[CellMap | PointMap]
