# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline as linear equations: its four states and its transfer functions to slip speed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.names import Names
from ddct_plant.models.parameters import DrivelineParameters

STATES = Names(('engine_speed', 'shaft_speed', 'wheel_speed', 'twist'))
"""States w_m, w_p, w_r in rad/s and theta_sr in rad."""
ANGLES = Names(('engine_angle', 'shaft_angle', 'wheel_angle'))
"""Angles in rad of the shafts with the first speeds of STATES, in their order."""
STATES_AND_ANGLES = STATES + ANGLES
TORQUES = Names(('engine_torque', 'clutch_torque', 'load_torque'))
"""Inputs C_m, C_f, C_load in N m."""
OUTPUTS = Names(('slip_speed', 'torsion_speed'))
"""Outputs w_d, w_sr in rad/s."""


@dataclass(frozen=True, eq=False)
class DrivelineModel(StateSpace):
    """Linear driveline in one gear, with the names of its states, inputs and outputs."""

    states: Names = STATES
    """Names of the states, (n,)."""
    torques: Names = TORQUES
    """Names of the inputs in N m, (m,)."""
    outputs: Names = OUTPUTS
    """Names of the outputs, (p,)."""

    def output(self, name: str) -> np.ndarray:
        """Return the row (n,) of C of an output."""
        return self.c[self.outputs[name]]

    def path(self, torque: str, output: str) -> StateSpace:
        """Return the system from one torque to one output."""
        column, row = self.torques.column(torque), self.outputs.column(output)
        return StateSpace(self.a, self.b[:, column], self.c[row], self.d[row, column])


def driveline_matrices(parameters: DrivelineParameters) -> DrivelineModel:
    """
    Return the state space of Section 1.5, for the gear of the parameters.

    x = [w_m, w_p, w_r, theta_sr], u = [C_m, C_f, C_load], y = [w_d, w_sr]. Row 3 is that of the
    thesis's matrix A, with c_sa/(J_v tau); its third differential equation prints c_sa/(J_p tau),
    an erratum: action and reaction of the half-shaft would differ. Equation (1.4) leaves out
    c_prim, which the matrix has.
    """
    a, b = states_and_torques(parameters)
    c = np.zeros((len(OUTPUTS), len(STATES)))
    c[OUTPUTS['slip_speed'], STATES.places('engine_speed', 'shaft_speed')] = 1.0, -1.0
    torsion = parameters.gear.wheel_speed(1.0), -1.0
    c[OUTPUTS['torsion_speed'], STATES.places('shaft_speed', 'wheel_speed')] = torsion
    return DrivelineModel(a, b, c, np.zeros((len(OUTPUTS), len(TORQUES))))


def states_and_torques(parameters: DrivelineParameters) -> tuple[np.ndarray, np.ndarray]:
    """Return a (..., 4, 4) and b (..., 4, 3); parameters that are arrays, (...), give stacks."""
    p = parameters
    gear, damping, stiffness = p.gear, p.halfshaft_damping, p.halfshaft_stiffness
    j_p, j_v = p.shaft_inertia, p.vehicle_inertia
    a = [
        [-p.engine_damping / p.engine_inertia, 0.0, 0.0, 0.0],
        [
            0.0,
            -(gear.at_shaft(damping) + p.shaft_damping) / j_p,
            damping / gear.across(j_p),
            -stiffness / gear.across(j_p),
        ],
        [0.0, damping / gear.across(j_v), -damping / j_v, stiffness / j_v],
        [0.0, gear.wheel_speed(1.0), -1.0, 0.0],
    ]
    b = [
        [1.0 / p.engine_inertia, -1.0 / p.engine_inertia, 0.0],
        [0.0, 1.0 / j_p, 0.0],
        [0.0, 0.0, -1.0 / j_v],
        [0.0, 0.0, 0.0],
    ]
    return _stacked(a), _stacked(b)


def _stacked(rows: Sequence[Sequence[float]]) -> np.ndarray:
    """Return the matrices (..., rows, columns) of entries that are numbers or arrays, (...)."""
    if not any(isinstance(entry, np.ndarray) for row in rows for entry in row):
        return np.array(rows)
    entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
    return np.stack(entries, axis=-1).reshape(*entries[0].shape, len(rows), len(rows[0]))


def matrices_with_angles(parameters: DrivelineParameters) -> tuple[np.ndarray, np.ndarray]:
    """
    Return a (..., 7, 7) and b (..., 7, 3) of the four states and the angles of w_m, w_p and w_r.

    Parameters that are arrays, (...), give stacks.
    """
    driven, torques = states_and_torques(parameters)
    stack, size = driven.shape[:-2], len(STATES_AND_ANGLES)
    states, angles = slice(0, len(STATES)), slice(len(STATES), size)
    a, b = np.zeros((*stack, size, size)), np.zeros((*stack, size, len(TORQUES)))
    a[..., states, states], b[..., states, :] = driven, torques
    a[..., angles, : len(ANGLES)] = np.eye(len(ANGLES))
    return a, b


def engine_to_slip(parameters: DrivelineParameters) -> FactoredTransferFunction:
    """Return P_1 = w_d / C_m = (1/J_m) / (s + c_m/J_m)."""
    gain = 1.0 / parameters.engine_inertia
    return FactoredTransferFunction(gain, (), (gain * parameters.engine_damping,))


def clutch_to_slip(parameters: DrivelineParameters) -> FactoredTransferFunction:
    """
    Return P_2 = w_d / C_f, factored in the layout the thesis prints it in.

    w_p / C_f = (J_v s^2 + c_sa s + k_sa) / D(s), with D the free driveline's cubic, and
    w_m / C_f = -1 / (J_m s + c_m). The zeros are the roots of
    D(s) + (J_m s + c_m)(J_v s^2 + c_sa s + k_sa): the driveline with the clutch locked, whose
    primary shaft has the inertia J_p + J_m and the damping c_prim + c_m.
    """
    p = parameters
    locked = _driveline_cubic(
        p, p.shaft_inertia + p.engine_inertia, p.shaft_damping + p.engine_damping
    )
    free = _driveline_cubic(p, p.shaft_inertia, p.shaft_damping)
    return FactoredTransferFunction(
        gain=-(1.0 / p.engine_inertia + 1.0 / p.shaft_inertia),
        numerator=_factored(locked),
        denominator=(p.engine_damping / p.engine_inertia, *_factored(free)),
    )


def load_to_slip(parameters: DrivelineParameters) -> FactoredTransferFunction:
    """Return P_3 = w_d / C_load = (c_sa s + k_sa) / (tau D(s)), laid out as the thesis does."""
    p = parameters
    free = _driveline_cubic(p, p.shaft_inertia, p.shaft_damping)
    return FactoredTransferFunction(
        gain=p.halfshaft_damping / (p.gear.across(p.shaft_inertia) * p.vehicle_inertia),
        numerator=(p.halfshaft_stiffness / p.halfshaft_damping,),
        denominator=_factored(free),
    )


def _driveline_cubic(
    parameters: DrivelineParameters, inertia: float, damping: float
) -> tuple[float, float, float]:
    """
    Return d_2, d_1, d_0 of the monic cubic of shaft, half-shaft and vehicle.

    D(s) = J J_v s^3 + (c J_v + J c_sa + c_sa J_v/tau^2) s^2
    + (J k_sa + c c_sa + k_sa J_v/tau^2) s + c k_sa, for a shaft of inertia J and damping c.
    """
    p = parameters
    reflected = p.gear.at_shaft(p.vehicle_inertia)
    leading = inertia * p.vehicle_inertia
    return (
        (damping * p.vehicle_inertia + (inertia + reflected) * p.halfshaft_damping) / leading,
        ((inertia + reflected) * p.halfshaft_stiffness + damping * p.halfshaft_damping) / leading,
        damping * p.halfshaft_stiffness / leading,
    )


def _factored(cubic: tuple[float, float, float]) -> tuple[float, tuple[float, float]]:
    """
    Return a and (b, c) with s^3 + d_2 s^2 + d_1 s + d_0 = (s + a)(s^2 + b s + c).

    -a is the slowest real root; b and c follow by division, without the other two roots.
    """
    d_2, d_1, d_0 = cubic
    roots = np.roots([1.0, d_2, d_1, d_0])
    real = roots[roots.imag == 0.0].real
    a = float(-real[np.argmin(np.abs(real))])
    b = d_2 - a
    return a, (b, d_1 - a * b)
