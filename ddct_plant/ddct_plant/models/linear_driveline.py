# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Driveline with a linear clutch, stepped exactly (Section 1.5)."""

from collections.abc import Sequence

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.sampling import hold_inputs, lift_piecewise_linear
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.driveline_model import (
    STATES,
    STATES_AND_ANGLES,
    TORQUES,
    matrices_with_angles,
    states_and_torques,
)
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters

_ENGINE_SPEED = STATES_AND_ANGLES['engine_speed']
_STEPPED = slice(0, len(STATES_AND_ANGLES))
_ENGINE_TORQUE, _LOAD_TORQUE = len(STATES_AND_ANGLES), len(STATES_AND_ANGLES) + 1
_NODES = slice(_LOAD_TORQUE + 1, None)
"""Columns of `step_matrix` with angles: states and angles, C_m, C_load, the nodes of C_f."""


class Driveline:
    """
    The four states of Section 1.5 and the three angles, in one exact integrator.

    Over a 10 ms period C_m and C_load are held and C_f is piecewise linear between 11 nodes, so
    the step is one matrix product. The 88 rad/s mode would lose 0.9 rad of phase per period if
    the inertias were integrated in separate nodes.
    """

    def __init__(
        self, parameters: DrivelineParameters, vehicle: VehicleParameters, initial: InitialState
    ) -> None:
        """Start in the given state."""
        self._parameters = parameters
        self._wheel_radius = vehicle.wheel_radius_m
        self._step_matrix = step_matrix(parameters)
        self._state_and_inputs = np.zeros(self._step_matrix.shape[1])
        self._state_and_inputs[: len(STATES)] = initial.states
        self._torques = (initial.engine_torque, initial.sides[0].torque, initial.load_torque)

    @property
    def engine_speed(self) -> float:
        """Engine speed w_m in rad/s at the present step."""
        return float(self._state_and_inputs[_ENGINE_SPEED])

    def outputs(self) -> DrivelineOutputs:
        """Return the outputs at the present step."""
        state = self._state_and_inputs[_STEPPED].tolist()
        return DrivelineOutputs.of_state(
            self._parameters, self._wheel_radius, state, self._torques
        )

    def step(
        self, engine_torque: float, load_torque: float, clutch_torque: Sequence[float]
    ) -> None:
        """Advance by 10 ms with held C_m and C_load and the (11,) nodes of C_f, all in N m."""
        values = self._state_and_inputs
        values[_ENGINE_TORQUE] = engine_torque
        values[_LOAD_TORQUE] = load_torque
        values[_NODES] = clutch_torque
        values[_STEPPED] = self._step_matrix @ values
        self._torques = (engine_torque, clutch_torque[-1], load_torque)


def step_matrix(parameters: DrivelineParameters, *, angles: bool = True) -> np.ndarray:
    """
    Return the matrix (..., 7, 20) to the next states and angles; (..., 4, 17) without the angles.

    Its columns are states and angles (7), C_m, C_load and the C_f nodes (11). Parameters that are
    arrays, (...), give a stack. Raise ParameterError where a number is not finite.
    """
    a, b = matrices_with_angles(parameters) if angles else states_and_torques(parameters)
    _require_finite(a, b)
    engine, clutch, load = (b[..., TORQUES.column(name)] for name in TORQUES)
    _, held = hold_inputs(a, np.concatenate([engine, load], axis=-1), PERIOD_S)
    transition, nodes = lift_piecewise_linear(a, clutch, PERIOD_S, SUBSTEPS)
    _require_finite(transition, held, nodes)
    return np.concatenate([transition, held, nodes], axis=-1)


def _require_finite(*matrices: np.ndarray) -> None:
    if not all(np.isfinite(matrix).all() for matrix in matrices):
        raise ParameterError('driveline: its matrices have numbers that are not finite')
