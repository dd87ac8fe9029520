# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Assignment of rows to columns at the least sum of costs, for the few sections of a cascade."""

import math
from collections.abc import Sequence

_FREE = -1
"""Row of a column that has none yet."""


def least_cost_columns(costs: Sequence[Sequence[float]]) -> list[int]:
    """
    Return the column of each row, no column twice, so that the sum of their costs is least.

    `costs` has at most as many rows as columns, and finite numbers. By shortest augmenting paths:
    D. F. Crouse, On implementing 2D rectangular assignment algorithms, IEEE Trans. Aerosp.
    Electron. Syst. 52(4), 2016. Of several assignments of least sum the result is that of
    `scipy.optimize.linear_sum_assignment`, whose import takes a node a quarter of a second.
    """
    rows, columns = len(costs), len(costs[0]) if costs else 0
    row_price, column_price = [0.0] * rows, [0.0] * columns
    column_of, row_of = [_FREE] * rows, [_FREE] * columns
    for first in range(rows):
        path, shortest = [_FREE] * columns, [math.inf] * columns
        remaining = list(range(columns - 1, -1, -1))
        row, cost, reached = first, 0.0, [first]
        scanned: list[int] = []
        while True:
            for column in remaining:
                length = cost + costs[row][column] - row_price[row] - column_price[column]
                if length < shortest[column]:
                    path[column], shortest[column] = row, length
            index = _nearest(remaining, shortest, row_of)
            end, cost = remaining[index], shortest[remaining[index]]
            scanned.append(end)
            remaining[index] = remaining[-1]
            remaining.pop()
            if row_of[end] == _FREE:
                break
            row = row_of[end]
            reached.append(row)
        row_price[first] += cost
        for row in reached[1:]:
            row_price[row] += cost - shortest[column_of[row]]
        for column in scanned:
            column_price[column] -= cost - shortest[column]
        _augment(first, end, path, column_of, row_of)
    return column_of


def _nearest(remaining: list[int], shortest: list[float], row_of: list[int]) -> int:
    """Return the index in `remaining` of the nearest column; of equal ones a free one."""
    nearest, least = 0, math.inf
    for index, column in enumerate(remaining):
        length = shortest[column]
        if length < least or (length == least and row_of[column] == _FREE):
            nearest, least = index, length
    return nearest


def _augment(
    first: int, end: int, path: list[int], column_of: list[int], row_of: list[int]
) -> None:
    """Assign the columns along the path from row `first` to the free column `end`."""
    column, row = end, _FREE
    while row != first:
        row = path[column]
        row_of[column] = row
        column_of[row], column = column, column_of[row]
