# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Work that the two clutches of many shifts do against each other."""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from ddct_bringup.batch.plant.motions import Maps, Runs, StackedForcing, by_mode
from ddct_bringup.batch.stacks import product
from ddct_plant.friction.engagements import OFF_GOING, ON_COMING, EngagedGears
from ddct_plant.friction.tie_up import TieUp
from ddct_plant.hybrid.friction_system import Signs
from ddct_plant.hybrid.interval_map import Interval, IntervalMap

_CLUTCHES = ON_COMING, OFF_GOING
_NO_EVENTS = Interval([], (), [], [], [])


class TieUps:
    """
    Tie-up work of the periods of R shifts, the counterpart of `TieUp`.

    A period in which both torques surely have one direction has none. Where both clutches slip in
    opposite directions throughout a period, |w_p1 - w_p2| is the sum of the sizes of their slips,
    so that with one capacity below the other throughout the work is a sum of known integrals.
    Other periods are integrated one by one.
    """

    def __init__(self, engaged: Sequence[EngagedGears]) -> None:
        """Prepare for the engaged gears of each run."""
        self._engaged = engaged
        self._tie_ups = {id(gears): TieUp(gears) for gears in engaged}
        integrators = [gears.integrator for gears in engaged]
        self._layout = integrators[0].layout
        self._torques, self._slips = (
            [Maps(integrators, partial(rows, element=clutch)) for clutch in _CLUTCHES]
            for rows in (IntervalMap.twice_torque, IntervalMap.slip_integrals)
        )

    def work(
        self,
        state: np.ndarray,
        signs: np.ndarray,
        forcing: StackedForcing,
        eventful: Mapping[int, Interval],
        running: np.ndarray,
    ) -> np.ndarray:
        """
        Return the works in J, (R,), of a period of the runs of a mask, (R,).

        `state` (R, n) and `signs` (R, N) are those at its start; `eventful` has the periods with
        events.
        """
        work = np.zeros(len(state))
        pressed = running & self._pressed(ON_COMING, forcing) & self._pressed(OFF_GOING, forcing)
        if not pressed.any():
            return work
        alone = np.zeros(len(state), dtype=bool)
        alone[list(eventful)] = True
        alone &= pressed
        for mode, runs in by_mode(signs, pressed & ~alone):
            values = np.hstack([state, forcing.inputs, forcing.in_force(mode, self._layout)])
            if mode[ON_COMING] * mode[OFF_GOING] < 0:
                alone[runs] = ~self._sum(mode, runs, values, forcing.kinetic, work)
            else:
                one, other = (self._direction(each, mode, runs, values) for each in _CLUTCHES)
                alone[runs] = (one * other)[runs] <= 0
        for run in np.flatnonzero(alone).tolist():
            work[run] = self._alone(run, state, signs, forcing, eventful.get(run, _NO_EVENTS))
        return work

    def _pressed(self, clutch: int, forcing: StackedForcing) -> np.ndarray:
        """Return whether a clutch can carry torque in the period, (R,)."""
        pressed: np.ndarray = forcing.static[:, self._layout.capacities[clutch]].max(axis=1) > 0.0
        return pressed

    def _direction(self, clutch: int, mode: Signs, runs: Runs, values: np.ndarray) -> np.ndarray:
        """Return the sign of a clutch's torque in the period, 0 where it may change, (R,)."""
        found = np.full(len(values), mode[clutch])
        if not mode[clutch]:
            for some, _, matrix in self._torques[clutch].of_mode(mode, runs):
                twice = product(matrix, values[some])
                positive, negative = twice.min(axis=1) > 0.0, twice.max(axis=1) < 0.0
                found[some] = positive.astype(int) - negative
        return found

    def _sum(
        self, mode: Signs, runs: Runs, values: np.ndarray, kinetic: np.ndarray, work: np.ndarray
    ) -> np.ndarray:
        """Set the works of runs whose clutches slip in opposite directions; return which."""
        one, other = (kinetic[runs, self._layout.capacities[clutch]] for clutch in _CLUTCHES)
        below, above = np.all(one <= other, axis=1), np.all(other <= one, axis=1)
        smaller = np.zeros((len(values), one.shape[1]))
        smaller[runs] = np.where(below[:, np.newaxis], one, other)
        for maps in self._slips:
            for some, _, matrix in maps.of_mode(mode, runs):
                work[some] += (product(matrix, values[some]) * smaller[some]).sum(axis=1)
        summed: np.ndarray = below | above
        return summed

    def _alone(
        self,
        run: int,
        state: np.ndarray,
        signs: np.ndarray,
        forcing: StackedForcing,
        after: Interval,
    ) -> float:
        before = Interval(state[run].tolist(), tuple(signs[run].tolist()), [], [], [])
        inputs, kinetic, static = (each[run].tolist() for each in forcing)
        return self._tie_ups[id(self._engaged[run])].work(before, after, inputs, kinetic, static)
