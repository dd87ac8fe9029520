# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Random drivelines with one to four friction elements, and their motion by the integrator."""

from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from modes import mode_at

from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator

PIECE_S, PIECES, INTERVALS = 0.001, 10, 8
INTERVAL_S = PIECE_S * PIECES
FASTEST = 600.0
"""Largest frequency in rad/s of an undamped mode."""
SEED = 52


class FrictionEvent(NamedTuple):
    """Event of a friction element: its time in s from the start, its index, and its kind."""

    time_s: float
    element: int
    kind: str


@dataclass
class Motion:
    """Speeds in rad/s at the ends of all intervals, events in their order, and grazes."""

    speeds: list[np.ndarray] = field(default_factory=list)
    events: list[FrictionEvent] = field(default_factory=list)
    grazes: int = 0
    """Number of times that a slip or margin turns within 1e-9 of zero, on either side."""
    peak: float = 0.0
    """Largest magnitude of a speed in rad/s."""

    def events_closer_than(self, within_s: float) -> bool:
        """Return whether two events at different instants are closer than this."""
        return any(0.0 < b.time_s - a.time_s < within_s for a, b in pairwise(self.events))


class RandomDriveline:
    """
    Inertias J with springs between them, speeds w, twists q of the springs, and N elements.

    J dw/dt = D u - v w - R' (k q + d R w) - S' f, dq/dt = R w, slips S w. The torques u are held
    over an interval, in which the kinetic capacities c are linear; the static ones are `ratio`
    times as large.
    """

    def __init__(self, index: int) -> None:
        """Draw the driveline of an index; that has 1 + index % 4 elements."""
        random = self._random = np.random.default_rng([SEED, index])
        self.elements = 1 + index % 4
        self.size = size = int(random.integers(max(2, self.elements), 6))
        self.inertias = 10.0 ** random.uniform(-2.0, 0.5, size)
        self.springs = self._springs()
        self.slips = self._slips()
        self.drive = np.eye(size)[:, random.permutation(size)[: random.integers(1, 3)]]
        self.stiffness = random.uniform(0.1, 1.0, len(self.springs))
        self.stiffness *= (random.uniform(10.0, FASTEST) / self.fastest()) ** 2
        most = random.choice([0.0, 0.1, 0.6]) / self.fastest()
        self.damping = self.stiffness * random.uniform(0.0, 1.0, len(self.springs)) * most
        self.viscous = self.inertias * random.uniform(0.0, 2.0, size)
        self.ratio = float(random.choice([1.0, 1.0, 1.2]))
        self.speeds = random.uniform(-2.0, 2.0, size) * random.choice([0.0, 1.0, 5.0])
        self.torques = random.uniform(-60.0, 60.0, (INTERVALS, self.drive.shape[1]))
        limits = random.uniform(-10.0, 50.0, (INTERVALS + 1, self.elements))
        self.capacities = np.maximum(limits, 0.0)
        """Kinetic capacities in N m at the ends of the intervals, (INTERVALS + 1, N)."""

    def _pair(self, one: int, ratio: float) -> np.ndarray:
        row = np.zeros(self.size)
        row[one] = 1.0
        if one + 1 < self.size:
            row[one + 1] = -ratio
        return row

    def _springs(self) -> np.ndarray:
        """Return rows (m, size) on the speeds: next inertias, or the last one and the ground."""
        chosen = self._random.random(self.size) < 0.6
        chosen[self._random.integers(self.size)] = True
        ratios = self._random.uniform(0.3, 3.0, self.size)
        rows = [self._pair(i, ratio) for i, ratio in enumerate(ratios)]
        return np.array(rows)[chosen]

    def _slips(self) -> np.ndarray:
        """Return independent rows (N, size) on the speeds: two inertias, or one and the ground."""
        ratios = self._random.choice([1.0, 1.0, 0.6, 2.5], self.size)
        rows = [*np.eye(self.size), *(self._pair(i, r) for i, r in enumerate(ratios[:-1]))]
        taken: list[np.ndarray] = []
        for place in self._random.permutation(len(rows)):
            if np.linalg.matrix_rank(np.array([*taken, rows[place]])) > len(taken):
                taken.append(rows[place])
        return np.array(taken[: self.elements])

    def fastest(self) -> float:
        """Return the largest frequency in rad/s without dampers and friction."""
        stiffness = self.springs.T @ (self.stiffness[:, None] * self.springs)
        return float(np.sqrt(np.linalg.eigvals(stiffness / self.inertias[:, None]).real.max()))

    def system(self) -> FrictionSystem:
        """Return the linear system of states [w, q] and inputs u."""
        over, size, twists = 1.0 / self.inertias[:, None], self.size, len(self.springs)
        none = np.zeros((twists, twists))
        resisted = self.springs.T @ (self.damping[:, None] * self.springs) + np.diag(self.viscous)
        a = np.block(
            [[-over * resisted, -over * self.springs.T * self.stiffness], [self.springs, none]]
        )
        still = np.zeros((twists, max(size, self.elements)))
        b = np.vstack([over * self.drive, still[:, : self.drive.shape[1]]])
        g = np.vstack([-over * self.slips.T, still[:, : self.elements]])
        return FrictionSystem(a, b, g, np.hstack([self.slips, still[:, : self.elements].T]))

    def integrated(self) -> Motion:
        """Return the motion by the hybrid integrator."""
        system = self.system()
        integrator = HybridIntegrator(system, PIECE_S, PIECES, held=range(system.b.shape[1]))
        state = np.concatenate([self.speeds, np.zeros(len(self.springs))]).tolist()
        signs, motion = mode_at(system, state), Motion()
        nodes = np.arange(PIECES + 1)[:, None] / PIECES
        for interval, (first, last) in enumerate(pairwise(self.capacities)):
            kinetic = (first + nodes * (last - first)).T.ravel()
            torques = self.torques[interval].tolist()
            done = integrator.advance(state, signs, torques, kinetic, self.ratio * kinetic)
            state, signs = done.state, done.signs
            motion.speeds.append(np.array(state[: self.size]))
            start_s = interval * INTERVAL_S
            motion.events += [
                FrictionEvent(start_s + e.time_s, e.element, e.kind) for e in done.events
            ]
        return motion
