"""Maps: quantities over two varied numbers, for every group, as the page draws them."""

from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np

from ddct_bringup.campaign_report.outcome import FAILED, failed_share
from ddct_bringup.campaign_report.results import Results
from ddct_bringup.report.page_parts import unit_text
from ddct_bringup.verdict.state import ENGAGED, INVALID

FAILED_SHARE = 'failed_share'
"""The quantity that is the share of failed engagements in a cell."""
MOST_MAPS = 10
"""That the page offers: all pairs of five numbers."""
MOST_POINTS = 300
"""Of a group that a map of samples shows, the first ones."""
_TELLING = (INVALID, FAILED, ENGAGED)
"""Which outcome of several runs marks their cell: the first of these that there is."""
_DIGITS, _PLACE_DIGITS = 4, 9
"""Of values, and of where they are."""


def campaign_maps(results: Results) -> dict[str, Any] | None:
    """
    Return what the page draws, as JSON has it; None where no number was varied.

    A map goes over two numbers, or over one alone. On a grid it has cells, in each the worst of
    the runs that differ in what was drawn at random; of random samples it has a point per run.
    The grid's other numbers are at their start.
    """
    numbers = results.numbers
    if not numbers:
        return None
    pairs = [[*pair] for pair in combinations(numbers, 2)][:MOST_MAPS]
    maps = [_map(results, keys) for keys in pairs or [numbers]]
    repeated = any(max(panel['runs'], default=0) > 1 for each in maps for panel in each['panels'])
    share = {'key': FAILED_SHARE, 'title': 'share of failed engagements', 'low': 0.0, 'high': 1.0}
    return {
        'quantities': [*([share] if repeated else []), *_scales(results)],
        'groups': [group.label for group in results.groups],
        'maps': maps,
    }


def _scales(results: Results) -> list[dict[str, Any]]:
    """Return the ends of each quantity's scale of colours, that of the engaged runs of all."""
    engaged = results.outcomes == ENGAGED
    found = []
    for figure in results.quantities:
        values = np.abs(results.columns[figure.key][engaged])
        values = values[~np.isnan(values)]
        low, high = (values.min(), values.max()) if values.size else (0.0, 0.0)
        title = f'{figure.symbol}, {unit_text(figure.unit)}'.removesuffix(', ')
        found.append({'key': figure.key, 'title': title, 'low': low, 'high': high})
    return found


def _map(results: Results, keys: Sequence[str]) -> dict[str, Any]:
    cells = all(key in results.grid for key in keys)
    others = {key: results.start_of(key) for key in results.others(keys)}
    panels = []
    for group in results.groups:
        rows = results.others_nominal(group.rows, keys)
        parts = results.alike(rows, keys) if cells else [np.array([row]) for row in rows]
        panels.append(_panel(results, parts[: None if cells else MOST_POINTS], keys))
    return {'keys': list(keys), 'cells': cells, 'others': others, 'panels': panels}


def _panel(results: Results, parts: Sequence[np.ndarray], keys: Sequence[str]) -> dict[str, Any]:
    """Return the cells or points of one group, column by column."""
    counts = [failed_share(results.outcomes[rows]) for rows in parts]
    repeated = any(len(rows) > 1 for rows in parts)
    telling = [_telling(results, rows) for rows in parts]
    states, index = results.columns['verdict_state'], results.columns['index']
    worst = {figure.key: _worst(results, figure.key, parts) for figure in results.quantities}
    return {
        'at': [_places(results.columns[key], parts) for key in keys],
        'runs': [len(rows) for rows in parts],
        'failed': [each.failed for each in counts],
        'invalid': [each.invalid for each in counts],
        'intervals': [each.interval() for each in counts] if repeated else None,
        'state': [str(states[row]) for row in telling],
        'index': [int(index[row]) for row in telling],
        'values': {key: [value for value, _ in found] for key, found in worst.items()},
        'rows': {key: [row for _, row in found] for key, found in worst.items()}
        if repeated
        else None,
    }


def _telling(results: Results, rows: np.ndarray) -> int:
    """Return the run that marks a cell: the first invalid one, else the first failed one."""
    return min(rows.tolist(), key=lambda row: _TELLING.index(results.outcomes[row]))


def _worst(
    results: Results, key: str, parts: Sequence[np.ndarray]
) -> list[tuple[float | None, int | None]]:
    """Return per cell the largest magnitude of its valid runs, and the index of that run."""
    values = np.where(results.outcomes == INVALID, np.nan, np.abs(results.columns[key]))
    found: list[tuple[float | None, int | None]] = []
    for rows in parts:
        if np.isnan(values[rows]).all():
            found.append((None, None))
        else:
            row = rows[np.nanargmax(values[rows])]
            value = float(f'{values[row]:.{_DIGITS}g}')
            found.append((value, int(results.columns['index'][row])))
    return found


def _places(values: np.ndarray, parts: Sequence[np.ndarray]) -> list[float]:
    """Return the varied number of each cell."""
    return [float(f'{values[rows[0]]:.{_PLACE_DIGITS}g}') for rows in parts]
