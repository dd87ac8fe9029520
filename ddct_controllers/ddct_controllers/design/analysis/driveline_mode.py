# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The mode of the driveline in a closed loop: its frequency, damping and amplitude."""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE
from ddct_controllers.design.loop_stack import LoopStack
from ddct_controllers.design.state_space import close_loop, to_s_plane
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters


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
    zero = locked_driveline_zero(parameters)
    index = -1 if zero is None else int(nearest_mode(rates, zero))
    if index < 0:
        return None
    model = driveline_matrices(parameters)
    row, column = left[:, index].conj(), right[:, index]
    torsion_rpm = RPM_PER_RAD_S * model.output('torsion_speed') @ column[-len(model.a) :]
    after_step = torsion_rpm * (row @ closed.b[:, 0]) / (row @ column) / (poles[index] - 1.0)
    return DrivelineMode(
        frequency_hz=float(abs(rates[index])) / math.tau,
        damping=float(damping(rates[index])),
        torsion_amplitude_rpm=2.0 * float(abs(after_step)),
    )


def locked_driveline_zero(parameters: DrivelineParameters) -> complex | None:
    """Return the zero of P_2 in the upper half of the s-plane, None when its zeros are real."""
    path = driveline_matrices(parameters).path('clutch_torque', 'slip_speed')
    (zero,) = locked_driveline_zeros(LoopStack.joined([path]))
    return None if np.isnan(zero) else complex(zero)


def locked_driveline_zeros(paths: LoopStack) -> np.ndarray:
    """
    Return the zero of P_2 in the upper half of the s-plane of many drivelines, (R,) complex.

    nan where the zeros are real. `paths` are the systems P_2. With the output held at 0 the input
    is -c a x / (c b): the eigenvalues of a - b c a / (c b) are the zeros, and a 0.
    """
    gain = (paths.c * paths.b).sum(axis=1)[:, np.newaxis, np.newaxis]
    slope = paths.c[:, np.newaxis] @ paths.a
    held = np.linalg.eigvals(paths.a - paths.b[:, :, np.newaxis] * slope / gain).astype(complex)
    zeros = np.take_along_axis(held, np.argmax(held.imag, axis=1)[:, np.newaxis], axis=1)[:, 0]
    return np.where(zeros.imag > 0.0, zeros, np.nan)


def nearest_mode(rates: np.ndarray, zeros: np.ndarray | complex) -> np.ndarray:
    """
    Return the index (...) of the oscillating pole among `rates`, (..., n), nearest `zeros`, (...).

    It is -1 where no pole oscillates, and where the zero is nan.
    """
    distance = np.abs(rates - np.asarray(zeros)[..., np.newaxis])
    distance = np.where((rates.imag > 0.0) & np.isfinite(distance), distance, np.inf)
    nearest = np.argmin(distance, axis=-1)
    return np.where(np.isfinite(distance).any(axis=-1), nearest, -1)


def damping(rates: np.ndarray) -> np.ndarray:
    """Return the damping ratio -Re s / |s| of poles s in rad/s, elementwise."""
    return -np.real(rates) / np.abs(rates)
