# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Maps of quantities over two varied numbers for every group, as JSON for the page."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign_report.map_types import (
    CampaignMaps,
    CellMap,
    MapPanel,
    MapScale,
    PointMap,
)
from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.evaluation.grouped_rows import GroupedRows
from ddct_bringup.evaluation.share import FAILED, Share
from ddct_bringup.verdict.state import ENGAGED, INVALID

FAILED_SHARE = 'failed_share'
"""Key of the share of failed engagements in a cell."""
MOST_MAPS = 10
"""Largest number of maps on the page: all pairs of five numbers."""
MOST_POINTS = 2500
"""Largest number of points of a group in a map of samples; a note gives the number of runs."""
_FIRST = (INVALID, FAILED, ENGAGED)
"""Outcomes that mark a cell of several runs, in order of precedence."""
_DIGITS, _PLACE_DIGITS = 4, 9
"""Significant digits of values and of coordinates."""


def campaign_maps(results: GroupedRows) -> CampaignMaps | None:
    """
    Return the maps of the page as JSON content; None where no number was varied or measured.

    A map has two varied numbers as axes, or one. On a grid it has cells, each with the worst of
    the runs that differ only at random; for random samples it has a point per run. The points of
    all maps are in `points`; a map has the indices of its own, or None for all. The other numbers
    of the grid are at their start.
    """
    numbers = results.numbers
    if not (numbers and results.quantities):
        return None
    pairs = [[*pair] for pair in combinations(numbers, 2)][:MOST_MAPS] or [numbers]
    cells = [_cells(results, keys) for keys in pairs if _on_grid(results, keys)]
    repeated = any(max(panel.runs, default=0) > 1 for each in cells for panel in each.panels)
    share: MapScale = MapScale(
        key=FAILED_SHARE,
        title='share of failed engagements',
        low=0.0,
        high=1.0,
    )
    drawn, points = _points(results, [keys for keys in pairs if not _on_grid(results, keys)])
    drawn_maps: list[CellMap | PointMap] = [*cells, *points]
    maps = {tuple(each.keys): each for each in drawn_maps}
    return CampaignMaps(
        quantities=[*([share] if repeated else []), *_scales(results)],
        groups=[group.label for group in results.groups],
        points=drawn,
        numbers=numbers,
        maps=[maps[tuple(keys)] for keys in pairs],
    )


def _on_grid(results: GroupedRows, keys: Sequence[str]) -> bool:
    return all(key in results.by.grid for key in keys)


def _scales(results: GroupedRows) -> list[MapScale]:
    """Return the ends of each quantity's colour scale: magnitudes of the engaged runs."""
    engaged = results.outcomes == ENGAGED
    found: list[MapScale] = []
    for quantity in results.quantities:
        values = np.abs(results.columns[quantity.key][engaged])
        values = values[~np.isnan(values)]
        low, high = (values.min(), values.max()) if values.size else (0.0, 0.0)
        title = f'{quantity.symbol}, {unit_text(quantity.unit)}'.removesuffix(', ')
        found.append(MapScale(key=quantity.key, title=title, low=low, high=high))
    return found


def _cells(results: GroupedRows, keys: Sequence[str]) -> CellMap:
    """Return a map over the grid."""
    parts = [
        results.alike(results.others_nominal(group.rows, keys), keys) for group in results.groups
    ]
    runs = sum(len(rows) for each in parts for rows in each)
    return CellMap(
        keys=list(keys),
        cells=True,
        others=_others(results, keys),
        extent=_extent(runs, results.rows),
        panels=[_panel(results, each, keys) for each in parts],
    )


def _points(
    results: GroupedRows, pairs: Sequence[Sequence[str]]
) -> tuple[list[MapPanel] | None, list[PointMap]]:
    """Return the points of each group in maps of samples, and these maps."""
    if not pairs:
        return None, []
    chosen = {
        tuple(keys): [
            _evenly(results.others_nominal(group.rows, keys)) for group in results.groups
        ]
        for keys in pairs
    }
    drawn = [np.unique(np.concatenate(rows)) for rows in zip(*chosen.values(), strict=True)]
    maps: list[PointMap] = [
        PointMap(
            keys=list(keys),
            cells=False,
            others=_others(results, keys),
            extent=_extent(sum(map(len, rows)), results.rows),
            panels=[
                None if len(ours) == len(every) else np.searchsorted(every, ours).tolist()
                for ours, every in zip(rows, drawn, strict=True)
            ],
        )
        for keys, rows in chosen.items()
    ]
    points = [_panel(results, rows[:, np.newaxis], results.numbers) for rows in drawn]
    return points, maps


def _evenly(rows: np.ndarray) -> np.ndarray:
    """Return at most `MOST_POINTS` of the rows, evenly spaced."""
    if len(rows) <= MOST_POINTS:
        return rows
    return rows[np.arange(MOST_POINTS) * len(rows) // MOST_POINTS]


def _others(results: GroupedRows, keys: Sequence[str]) -> dict[str, float]:
    return {key: results.start_of(key) for key in results.others(keys)}


def _extent(drawn: int, runs: int) -> str:
    """Return the note on which runs a map shows."""
    return f'all {runs} runs' if drawn == runs else f'{drawn} of {runs} runs'


def _panel(
    results: GroupedRows, parts: Sequence[np.ndarray] | np.ndarray, keys: Sequence[str]
) -> MapPanel:
    """Return the cells or points of one group, column by column."""
    counts = _counts(results.outcomes, parts)
    repeated = any(len(rows) > 1 for rows in parts)
    marking = [_marking(results, rows) for rows in parts]
    states, index = results.columns[STATE], results.columns['index']
    worst = {quantity.key: _worst(results, quantity.key, parts) for quantity in results.quantities}
    return MapPanel(
        at=[_places(results.columns[key], parts) for key in keys],
        runs=[len(rows) for rows in parts],
        failed=[failed for failed, _ in counts],
        invalid=[invalid for _, invalid in counts],
        intervals=_intervals(parts, counts) if repeated else None,
        state=[str(states[row]) for row in marking],
        index=[int(index[row]) for row in marking],
        values={key: [value for value, _ in found] for key, found in worst.items()},
        rows={key: [row for _, row in found] for key, found in worst.items()}
        if repeated
        else None,
    )


def _counts(
    outcomes: np.ndarray, parts: Sequence[np.ndarray] | np.ndarray
) -> list[tuple[int, int]]:
    """Return the numbers of failed and of invalid runs in each cell, or of each point."""
    if isinstance(parts, np.ndarray):  # a point is one run
        return [(int(each == FAILED), int(each == INVALID)) for each in outcomes[parts[:, 0]]]
    return [
        (int(np.sum(outcomes[rows] == FAILED)), int(np.sum(outcomes[rows] == INVALID)))
        for rows in parts
    ]


def _intervals(
    parts: Sequence[np.ndarray] | np.ndarray, counts: Sequence[tuple[int, int]]
) -> list[tuple[float | None, float | None]]:
    """Return the ends of the interval of the share of failed runs in each cell."""
    shares = (
        Share.in_sample(failed, len(rows) - invalid, invalid)
        for rows, (failed, invalid) in zip(parts, counts, strict=True)
    )
    return [(share.low, share.high) for share in shares]


def _marking(results: GroupedRows, rows: np.ndarray) -> int:
    """Return the run that marks a cell: the first invalid one, else the first failed one."""
    return min(rows.tolist(), key=lambda row: _FIRST.index(results.outcomes[row]))


def _worst(
    results: GroupedRows, key: str, parts: Sequence[np.ndarray] | np.ndarray
) -> list[tuple[float | None, int | None]]:
    """Return per cell the value of largest magnitude of its valid runs, and that run's index."""
    values = np.where(results.outcomes == INVALID, np.nan, results.columns[key])
    index = results.columns['index']
    if isinstance(parts, np.ndarray):
        rows = parts[:, 0]
        return [
            (None, None) if np.isnan(value) else (float(f'{value:.{_DIGITS}g}'), run)
            for value, run in zip(values[rows].tolist(), index[rows].tolist(), strict=True)
        ]
    found: list[tuple[float | None, int | None]] = []
    for rows in parts:
        if np.isnan(values[rows]).all():
            found.append((None, None))
        else:
            row = rows[np.nanargmax(np.abs(values[rows]))]
            value = float(f'{values[row]:.{_DIGITS}g}')
            found.append((value, int(index[row])))
    return found


def _places(values: np.ndarray, parts: Sequence[np.ndarray] | np.ndarray) -> list[float]:
    """Return the value of the varied number in each cell."""
    return [float(f'{values[rows[0]]:.{_PLACE_DIGITS}g}') for rows in parts]
