# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Variables of the signals of a run: the constant, its requests, and what laws leave over."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.dynamics.capacity import CapacityRange
from ddct_bringup.floor.dynamics.laws import Law
from ddct_bringup.floor.dynamics.off_going import OffGoing
from ddct_bringup.floor.dynamics.propagators import NODES
from ddct_bringup.floor.dynamics.shapes import SHAPES


@dataclass(frozen=True, eq=False)
class Columns:
    """
    Variables of the signals: column 0 is the constant, then requests, then what is left over.

    The requests are those from control start to the last with an effect on the signals. What the
    laws of load, engine and capacity leave over follows, one column for each period.
    """

    requests: int
    """Number of requests, in columns 1 to `requests`."""
    load: slice
    engine: slice
    capacity: slice
    nodes: slice
    """Columns of what clipping adds at the nodes of C_f, NODES for each clipped period."""
    clipped: tuple[int, ...]
    """Periods after control start whose capacity is clipped."""
    off_going: slice
    """Columns of the off-going clutch's torque in a gear shift, SHAPES for each period in which it
    is a variable."""
    low: np.ndarray
    high: np.ndarray
    """Intervals of all variables but the constant, (count - 1,)."""

    @property
    def count(self) -> int:
        """Number of columns, the constant included."""
        return 1 + len(self.low)

    def of_nodes(self, period: int) -> slice:
        """Return the columns of the nodes of a clipped period."""
        first = self.nodes.start + self.clipped.index(period) * NODES
        return slice(first, first + NODES)

    def of_shapes(self, place: int) -> slice:
        """Return the columns of C_1 in the period at a place among those with a variable C_1."""
        first = self.off_going.start + place * SHAPES
        return slice(first, first + SHAPES)


def columns_of(
    requests: int,
    most_request: float,
    load: Law,
    engine: Law,
    capacity: CapacityRange,
    periods: int,
    slipping_periods: int,
    off_going: OffGoing | None = None,
) -> Columns:
    """
    Return the variables of a run of `periods` from control start.

    Laws without any freedom have no columns. The plates slip in the first `slipping_periods`, and
    only these have a capacity. Requests are between 0 and `most_request` in N m.
    """
    low, high = [np.zeros(requests)], [np.full(requests, most_request)]
    slices, first = [], 1 + requests
    clipped = tuple(k for k in sorted(capacity.clipped) if k < slipping_periods)
    for law in (load, engine):
        free = bool(np.any(law.high[:periods] > law.low[:periods]))
        used = periods if free else 0
        low.append(law.low[:used])
        high.append(law.high[:used])
        slices.append(slice(first, first + used))
        first += used
    used = slipping_periods if capacity.high > capacity.low else 0
    low.append(np.full(used, capacity.low))
    high.append(np.full(used, capacity.high))
    slices.append(slice(first, first + used))
    first += used
    for k in clipped:
        least, most = capacity.clipped[k]
        low.append(least)
        high.append(most)
    slices.append(slice(first, first + len(clipped) * NODES))
    first += len(clipped) * NODES
    most = np.zeros(0) if off_going is None else off_going.most.ravel()
    low.append(-most)
    high.append(most)
    slices.append(slice(first, first + len(most)))
    of_load, of_engine, of_capacity, nodes, of_off_going = slices
    return Columns(
        requests,
        of_load,
        of_engine,
        of_capacity,
        nodes,
        clipped,
        of_off_going,
        np.concatenate(low),
        np.concatenate(high),
    )
