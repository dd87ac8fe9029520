# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Motions of many runs with dry friction: those without an event in a period step together."""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ddct_bringup.batch.stacks import by_run, distinct, product
from ddct_plant.base.errors import DdctError
from ddct_plant.hybrid.friction_system import IntervalLayout, Signs
from ddct_plant.hybrid.integrator import HybridIntegrator
from ddct_plant.hybrid.interval_map import Interval, IntervalMap

CLOSE = 1e-9
"""
Least value of a guard over its size without which a period goes to the integrator of its run.

The size of a slip is that of the speeds it is the difference of, that of a margin the capacity.
"""
Runs = slice | np.ndarray
"""Indices of some runs; a slice for all of them, so that nothing is copied."""


class StackedForcing(NamedTuple):
    """Values of a period as `HybridIntegrator.advance` takes them, of R runs."""

    inputs: np.ndarray
    """Held inputs, (R, m)."""
    kinetic: np.ndarray
    """Kinetic capacities, (R, c)."""
    static: np.ndarray
    """Static capacities, (R, c)."""

    def of(self, runs: Runs) -> 'StackedForcing':
        """Return the values of some runs."""
        return StackedForcing(*(each[runs] for each in self))

    def in_force(self, signs: Signs, layout: IntervalLayout) -> np.ndarray:
        """Return the capacities in a mode, (R, c): static for elements that stick."""
        capacities = self.kinetic.copy()
        for element, where in enumerate(layout.capacities):
            if not signs[element]:
                capacities[:, where] = self.static[:, where]
        return capacities


class Motions:
    """States and modes of R motions, the counterpart of `HybridIntegrator` with its intervals."""

    def __init__(
        self, integrators: Sequence[HybridIntegrator], start: Sequence[Interval], keep: bool
    ) -> None:
        """
        Take the integrator of each run, and the interval at whose end it starts.

        `keep` says whether intervals with events have their courses.
        """
        self.state = np.array([each.state for each in start])
        """States, (R, n)."""
        self.signs = np.array([each.signs for each in start])
        """Modes, (R, N)."""
        self.friction = np.array([each.friction for each in start])
        """Friction torques at the end of the last period, (R, N), left limits."""
        self.work = np.array([each.work for each in start])
        """Friction work of each element in the last period, (R, N)."""
        self.eventful: dict[int, Interval] = {}
        """Last periods with events, by the index of their run."""
        self.failed = np.zeros(len(start), dtype=bool)
        """Runs that could not be integrated, (R,); they are where they were before."""
        self._maps = Maps(integrators)
        self._integrators, self._keep = integrators, keep

    def take(self, integrators: Sequence[HybridIntegrator], state: np.ndarray) -> None:
        """Go on with other systems of the same elements, in the states (R, n)."""
        self.state, self._maps, self._integrators = state, Maps(integrators), integrators

    def advance(self, forcing: StackedForcing, running: np.ndarray) -> None:
        """Integrate one interval of the runs of a mask, (R,)."""
        self.eventful = {}
        sizes = self._maps.speeds(self.state)
        for signs, runs in by_mode(self.signs, running & ~self.failed):
            for some, at_once, matrix in self._maps.of_mode(signs, runs):
                self._advance_some(signs, some, at_once, matrix, forcing, sizes)

    def _advance_some(
        self,
        signs: Signs,
        runs: Runs,
        at_once: IntervalMap,
        matrix: np.ndarray,
        forcing: StackedForcing,
        sizes: np.ndarray,
    ) -> None:
        """Integrate runs in one mode, those with a possible event one by one."""
        layout, given = self._integrators[0].layout, forcing.of(runs)
        capacities, sizes = given.in_force(signs, layout), sizes[runs].copy()
        for element, where in enumerate(layout.capacities):
            if not signs[element]:
                sizes[:, element] = capacities[:, where].max(axis=1)
        values = product(matrix, np.hstack([self.state[runs], given.inputs, capacities]))
        ends = at_once.of_many(values, capacities)
        # Not `<`: a value that is not a number must not pass either.
        sure = (ends.least >= CLOSE * sizes).all(axis=1)
        before = self.state[runs].copy()
        self.state[runs], self.friction[runs], self.work[runs] = ends[:3]
        for place in np.flatnonzero(~sure).tolist():
            run = place if isinstance(runs, slice) else int(runs[place])
            self.state[run] = before[place]
            self._advance_one(run, signs, forcing)

    def _advance_one(self, run: int, signs: Signs, forcing: StackedForcing) -> None:
        """Integrate one run from event to event."""
        inputs, kinetic, static = (each[run].tolist() for each in forcing)
        if kinetic == static:
            static = kinetic
        try:
            end = self._integrators[run].advance(
                self.state[run].tolist(), signs, inputs, kinetic, static, self._keep
            )
        except DdctError:
            self.failed[run] = True
            return
        self.state[run], self.signs[run] = end.state, end.signs
        self.friction[run], self.work[run] = end.friction, end.work
        if end.events:
            self.eventful[run] = end
            self._maps.prepare_modes_of(run)


class Maps:
    """Matrices of R runs over an interval, by the mode: one for all, or one for each run."""

    def __init__(
        self,
        integrators: Sequence[HybridIntegrator],
        matrix_of: Callable[[IntervalMap], np.ndarray] = IntervalMap.matrix,
    ) -> None:
        """Take the matrix that `matrix_of` returns for the map of a run in a mode."""
        self._integrators, self._matrix_of = integrators, matrix_of
        first, places = distinct(map(id, integrators))
        self._shared = len(first) == 1
        self._slips = by_run([integrators[i].system.size_of_h for i in first], places)
        self._prepared: set[Signs] = set()
        """Modes that are prepared for all runs."""
        self._matrices: dict[Signs, np.ndarray] = {}
        """Matrices of all runs, where these have one integrator."""
        self._heights: dict[Signs, np.ndarray] = {}
        """Rows of the matrix of each run in a mode, (R,); 0 where it is not made."""
        self._stacks: dict[tuple[Signs, int], np.ndarray] = {}
        self._latest: dict[tuple[Signs, int], tuple[np.ndarray, np.ndarray]] = {}
        """Runs that were in a mode most recently, and their matrices."""

    def speeds(self, state: np.ndarray) -> np.ndarray:
        """Return the sizes of the speeds whose difference a slip is, (R, N)."""
        return product(self._slips, np.abs(state))

    def of_mode(self, signs: Signs, runs: Runs) -> Iterator[tuple[Runs, IntervalMap, np.ndarray]]:
        """Yield runs with matrices of one height: the runs, the map of one, and the matrices."""
        if self._shared:
            at_once = self._integrators[0].maps[signs]
            if signs not in self._matrices:
                self._matrices[signs] = self._matrix_of(at_once)
            yield runs, at_once, self._matrices[signs]
            return
        heights = self._made(signs, runs)[runs]
        for height in sorted({*heights.tolist()}):
            some = runs
            if (heights != height).any():
                some = np.arange(len(self._integrators))[runs][heights == height]
            first = 0 if isinstance(some, slice) else int(some[0])
            at_once = self._integrators[first].maps[signs]
            yield some, at_once, self._of_runs((signs, height), some)

    def _of_runs(self, key: tuple[Signs, int], runs: Runs) -> np.ndarray:
        """Return the matrices of some runs; copied once while these are in the mode together."""
        if isinstance(runs, slice):
            return self._stacks[key]
        if key not in self._latest or not np.array_equal(self._latest[key][0], runs):
            self._latest[key] = runs, self._stacks[key][runs]
        return self._latest[key][1]

    def prepare_modes_of(self, run: int) -> None:
        """Prepare the modes that a run has had for all runs, which takes each less than alone."""
        if not self._shared:
            for signs in self._integrators[run].maps.keys() - self._prepared:
                HybridIntegrator.prepare(self._integrators, signs)
                self._prepared.add(signs)

    def _made(self, signs: Signs, runs: Runs) -> np.ndarray:
        """Make the matrices of runs in a mode where they are not yet; return the heights (R,)."""
        count = len(self._integrators)
        heights = self._heights.setdefault(signs, np.zeros(count, dtype=int))
        if not heights[runs].all():
            HybridIntegrator.prepare(self._integrators, signs)
            for run in np.arange(count)[runs][heights[runs] == 0].tolist():
                matrix = self._matrix_of(self._integrators[run].maps[signs])
                key = signs, len(matrix)
                if key not in self._stacks:
                    self._stacks[key] = np.empty((count, *matrix.shape))
                self._stacks[key][run], heights[run] = matrix, len(matrix)
        return heights


def by_mode(signs: np.ndarray, running: np.ndarray) -> Iterator[tuple[Signs, Runs]]:
    """Yield each mode of running runs, and these runs."""
    codes = signs @ 3 ** np.arange(signs.shape[1])
    if running.all() and (codes == codes[0]).all():
        yield tuple(signs[0].tolist()), slice(None)
        return
    for code in sorted({*codes[running].tolist()}):
        runs = np.flatnonzero(running & (codes == code))
        yield tuple(signs[runs[0]].tolist()), runs
