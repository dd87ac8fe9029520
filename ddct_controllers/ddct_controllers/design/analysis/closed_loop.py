# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Closed-loop behaviour: step response, mode of the driveline, and Nyquist criterion.

Rise time and overshoot are as the thesis measures them. P_cl = P_ol + N is that of Section 2.2.1.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, ContinuousLoop
from ddct_controllers.design.state_space import close_loop, to_s_plane
from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.driveline_model import clutch_to_slip, driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters

TIME_STEP_S = 0.001
"""Time in s between the points at which a continuous loop is evaluated, each of them exact."""
_BLOCK = 128
"""
Number of points computed at once.

python-control takes one after another, 10 to 80 times as long.
"""
_INDENTATION_RAD_S = 1e-6
"""
Radius in rad/s of the half circles past poles on the imaginary axis.

A closed-loop pole within one would be missed: one that the loop hardly moves off the axis.
"""
_ON_AXIS = 1e-9
"""Real part, relative to the magnitude, below which a closed-loop pole is on the axis."""


def step_response(
    loop: ContinuousLoop | StateSpace, duration_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return time in s and the output of L/(1 + L) for a unit step of the reference, both (n,).

    A sampled loop gives its samples, a continuous one a point per millisecond. Raise
    ParameterError for a continuous loop with delay.
    """
    require_number('duration_s', duration_s, above=0.0)
    system = loop.to_state_space() if isinstance(loop, ContinuousLoop) else loop
    period_s = system.period_s or TIME_STEP_S
    time = period_s * np.arange(round(duration_s / period_s) + 1)
    closed = close_loop(system)
    sampled = closed if closed.period_s else discretise_zoh(closed, period_s)
    return time, _output_of_step(sampled, len(time))


def _output_of_step(system: StateSpace, points: int) -> np.ndarray:
    """Return the (points,) output of a sampled system at rest whose input becomes 1 at 0."""
    order = len(system.a)
    # With the input as a further state, which stays 1, the system runs by itself.
    a = np.block([[system.a, system.b], [np.zeros(order), 1.0]])
    rows = [np.hstack([system.c[0], system.d[0]])]
    for _ in range(_BLOCK - 1):
        rows.append(rows[-1] @ a)
    over_block = np.linalg.matrix_power(a, _BLOCK)
    state = np.eye(order + 1)[-1]
    blocks = []
    for _ in range(0, points, _BLOCK):
        blocks.append(np.array(rows) @ state)
        state = over_block @ state
    return np.concatenate(blocks)[:points]


def rise_time_and_overshoot(
    loop: ContinuousLoop | StateSpace, duration_s: float
) -> tuple[float | None, float]:
    """Return rise time in s, None if it is never over, and overshoot as a fraction."""
    response = step_response(loop, duration_s)
    return rise_time_s(*response), overshoot(*response)


def rise_time_s(time: np.ndarray, output: np.ndarray) -> float | None:
    """
    Return the first time in s at which the output crosses 1, t_r of Section 2.1; None if never.

    Linear between points. The final value is that of a loop with an integrator, 1, not the last
    point: slow poles take minutes to settle.
    """
    above = np.flatnonzero(output >= 1.0)
    if not above.size or above[0] == 0:
        return float(time[0]) if above.size else None
    after = int(above[0])
    before = after - 1
    share = (1.0 - output[before]) / (output[after] - output[before])
    return float(time[before] + share * (time[after] - time[before]))


def overshoot(time: np.ndarray, output: np.ndarray) -> float:
    """Return the largest excess of the output over the final value 1, as a fraction."""
    return max(0.0, float(np.max(output)) - 1.0)


@dataclass(frozen=True)
class NyquistCount:
    """Numbers of the Nyquist criterion for a loop."""

    open_loop_unstable: int
    """Number P_ol of poles of L with positive real part."""
    encirclements: int
    """Number N of encirclements of -1 for w from -inf to inf: clockwise less counterclockwise."""

    @property
    def closed_loop_unstable(self) -> int:
        """Number P_cl of roots of 1 + L with positive real part."""
        return self.open_loop_unstable + self.encirclements


def nyquist_count(loop: ContinuousLoop) -> NyquistCount:
    """
    Count the encirclements of -1 by a strictly proper L without dead time.

    The contour passes poles on the imaginary axis on the right, so that they count as stable.
    Raise ParameterError when L is not strictly proper or has a dead time, DdctError when the
    curve passes through -1.
    """
    factored = loop.transfer_function
    if len(factored.zeros) >= len(factored.poles):
        raise ParameterError('Nyquist count: L(s) must have more poles than zeros')
    system = loop.to_state_space()
    closed = np.linalg.eigvals(close_loop(system).a)
    if np.any(np.abs(closed.real) <= _ON_AXIS * np.abs(closed)):
        raise DdctError('Nyquist count: L(jw) passes through -1: change the gain a little')
    import control  # takes a second

    theirs = control.ss(system.a, system.b, system.c, system.d)
    curve = control.nyquist_response(theirs, indent_radius=_INDENTATION_RAD_S)
    return NyquistCount(int(np.count_nonzero(factored.poles.real > 0.0)), int(curve.count))


@dataclass(frozen=True)
class DrivelineMode:
    """
    The closed-loop pole pair nearest the zeros of P_2, the driveline with the clutch locked.

    Slip control pushes poles onto those zeros (2.93 Hz, damping 0.145), or the controller brings
    poles that cancel them: hidden in w_d, but ringing in C_f, w_sr and A_x.
    """

    frequency_hz: float
    """Frequency in Hz: magnitude of the pole over 2 pi."""
    damping: float
    """
    Damping ratio: minus the pole's real part over its magnitude; negative for a growing mode.
    """
    torsion_amplitude_rpm: float
    """First amplitude in rpm of the mode in w_sr after a step of 1 rpm of the reference."""


def driveline_mode(
    loop: StateSpace, parameters: DrivelineParameters = IDENTIFIED_DRIVELINE
) -> DrivelineMode | None:
    """
    Return the mode of a loop that `sampled_loop` made with the same `parameters`.

    None when the closed loop has no oscillating pole, or the locked driveline does not oscillate.
    """
    closed = close_loop(loop)
    poles, left, right = scipy.linalg.eig(closed.a, left=True, right=True)
    rates = to_s_plane(poles, loop.period_s)
    index = nearest_mode(rates, locked_driveline_zero(parameters))
    if index is None:
        return None
    row, column = left[:, index].conj(), right[:, index]
    model = driveline_matrices(parameters)
    torsion_rpm = RPM_PER_RAD_S * model.output('torsion_speed') @ column[-len(model.a) :]
    after_step = torsion_rpm * (row @ closed.b[:, 0]) / (row @ column) / (poles[index] - 1.0)
    return DrivelineMode(
        frequency_hz=float(abs(rates[index])) / math.tau,
        damping=float(damping(rates[index])),
        torsion_amplitude_rpm=2.0 * float(abs(after_step)),
    )


def locked_driveline_zero(parameters: DrivelineParameters) -> complex | None:
    """Return the zero of P_2 in the upper half of the s-plane, None when its zeros are real."""
    upper = [zero for zero in clutch_to_slip(parameters).zeros if zero.imag > 0.0]
    return complex(upper[0]) if upper else None


def nearest_mode(rates: np.ndarray, zero: complex | None) -> int | None:
    """Return the index of the oscillating pole among `rates`, (n,), that is nearest `zero`."""
    upper = np.flatnonzero(rates.imag > 0.0)
    if zero is None or not upper.size:
        return None
    return int(upper[np.argmin(np.abs(rates[upper] - zero))])


def damping(rates: np.ndarray) -> np.ndarray:
    """Return the damping ratio -Re s / |s| of poles s in rad/s, elementwise."""
    return -np.real(rates) / np.abs(rates)
