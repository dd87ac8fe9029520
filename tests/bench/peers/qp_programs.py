# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quadratic programs of predictive slip control along a run of the thesis's plant."""

from typing import NamedTuple

import numpy as np

from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.mpc.qp.backend import DEFAULT_BACKEND, make_backend
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.sampling import discretise_zoh

STEPS = 300
LIMIT = 20_000
"""Limit of iterations of the solvers, which none of them reaches."""
_OUTPUT_WEIGHT, _MOVE_WEIGHT = 0.26, 0.39
"""Weights of the thesis: of the slip error per rpm, of a move of the torque per N m."""
_SOFT_WEIGHT = 10.0
_MOVE_N_M, _TORQUE_N_M, _BAND_RPM = 5.0, 60.0, 20.0
"""Bounds of a move and of the torque, either side of 0, and of the slip around its reference."""


class Step(NamedTuple):
    """Vectors of one program, which change from step to step; the matrices stay."""

    f: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


class SlipControl:
    """
    Predictive control of the slip: bounded moves of a bounded torque against the predicted error.

    With `soft`, each predicted slip speed also has a soft row that keeps it near its reference.
    """

    def __init__(self, moves: int, outputs: int, soft: bool) -> None:
        self._plant = discretise_zoh(plant_in_rpm().to_state_space(), PERIOD_S)
        powers = [np.linalg.matrix_power(self._plant.a, i) for i in range(outputs + 1)]
        pulse = [(self._plant.c @ power @ self._plant.b).item() for power in powers[:-1]]
        self._held = np.cumsum(pulse)
        self._free = np.vstack([self._plant.c @ power for power in powers[1:]])
        self._response = np.zeros((outputs, moves))
        for move in range(moves):
            self._response[move:, move] = self._held[: outputs - move]
        rows = [np.eye(moves), np.tril(np.ones((moves, moves)))]
        self._soft = soft
        self.structure = QpStructure(
            _OUTPUT_WEIGHT**2 * self._response.T @ self._response
            + _MOVE_WEIGHT**2 * np.eye(moves),
            np.vstack([*rows, self._response] if soft else rows),
            np.arange(2 * moves + soft * outputs) >= 2 * moves,
            _SOFT_WEIGHT,
        )

    def steps(self) -> list[Step]:
        """Return `STEPS` programs of a loop with steps of the reference and a sinusoidal load."""
        backend = make_backend(DEFAULT_BACKEND, self.structure, LIMIT)
        state, torque, steps = np.zeros(len(self._plant.a)), 0.0, []
        for k in range(STEPS):
            reference = 100.0 * np.sign(np.sin(2.0 * np.pi * k / 100.0))
            load = 15.0 * np.sin(2.0 * np.pi * k / 70.0)
            free = self._free @ state + self._held * (torque + load)
            steps.append(self._step(reference - free, torque))
            torque += backend.solve(*steps[-1]).z[0]
            state = self._plant.a @ state + self._plant.b[:, 0] * (torque + load)
        return steps

    def _step(self, error: np.ndarray, torque: float) -> Step:
        moves = self._response.shape[1]
        move, level = np.full(moves, _MOVE_N_M), np.full(moves, _TORQUE_N_M)
        band = np.full(len(error), _BAND_RPM)
        lower = [-move, -level - torque, error - band]
        upper = [move, level - torque, error + band]
        kept = 2 + self._soft
        return Step(
            -(_OUTPUT_WEIGHT**2) * self._response.T @ error,
            np.concatenate(lower[:kept]),
            np.concatenate(upper[:kept]),
        )
