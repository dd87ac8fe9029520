# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The loop opened at the slip error, L = G_c G_a P_2 30/pi K_usura, and its Nyquist curve."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from ddct_controllers.design.delayed_input import sampled_behind_delay
from ddct_controllers.design.state_space import close_loop, frequency_response, poles_rad_s, series
from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.driveline_model import clutch_to_slip, driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR

IDENTIFIED_DRIVELINE = DrivelineParameters()
PRINTED_ACTUATOR = ActuatorParameters()
"""Actuator with 10 ms delay and G_a(s): for designs of the thesis and ours, not for runs."""
WEAR_RANGE = (0.7, 1.3)
"""Ends of the range of K_usura, without unit: inequality (3.2), Table 5.2."""
Measure = Callable[[np.ndarray], np.ndarray]
"""Real function of L(j omega), elementwise."""
_GRID_POINTS = 1500
_SLOWEST_RAD_S = 1e-5
_FASTEST_RAD_S = 1e5
"""
Ends of the grid of a continuous loop in rad/s.

A sampled one ends at half its sampling rate.
"""
_DISTANCES = np.geomspace(1e-4, 0.1, 12)
"""Distances of further grid points from every pole's frequency, relative, on both sides."""
_NEAR_THE_PEAK = 0.95
"""Share of the highest value on the grid from which a local maximum is refined too."""


@dataclass(frozen=True)
class ContinuousLoop:
    """A continuous L(s), with a dead time if the actuator's delay is counted."""

    transfer_function: FactoredTransferFunction
    """Transfer function L(s) without the dead time."""
    delay_s: float = 0.0

    def __post_init__(self) -> None:
        """Check the delay; raise ParameterError when it is negative or no number."""
        require_number('delay_s', self.delay_s, at_least=0.0)

    def response(self, omega: np.ndarray) -> np.ndarray:
        """Return L(j omega), the shape of `omega`, at frequencies in rad/s."""
        delay = np.exp(-1j * self.delay_s * np.asarray(omega, dtype=float))
        return self.transfer_function.frequency_response(omega) * delay

    def to_state_space(self) -> StateSpace:
        """Return a realisation; raise ParameterError for a loop with delay, which has none."""
        if self.delay_s:
            raise ParameterError(
                f'loop: a delay of {self.delay_s:g} s has no state space: leave it out, or sample'
            )
        return self.transfer_function.to_state_space()


def plant_in_rpm(
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE, wear_gain: float = 1.0
) -> FactoredTransferFunction:
    """Return G_a P_2 30/pi K_usura: slip speed in rpm for the torque requested in N m."""
    gain = FactoredTransferFunction(RPM_PER_RAD_S * wear_gain)
    return gain * ACTUATOR * clutch_to_slip(parameters)


def continuous_loop(
    controller: FactoredTransferFunction,
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
    delay_s: float = 0.0,
) -> ContinuousLoop:
    """
    Return L(s) = G_c G_a P_2 30/pi, with a new clutch, for a controller in N m per rpm of error.

    The thesis designs and judges its loops without hold and delay (Sections 2.2 and 3.2).
    """
    return ContinuousLoop(controller * plant_in_rpm(parameters), delay_s)


def sampled_plant(
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
    wear_gain: float = 1.0,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> StateSpace:
    """
    Return the actuator's delay times G_a P_2 30/pi K_usura under a zero-order hold at 10 ms.

    States: the delayed requests in N m, of the printed actuator one; those of G_a; then those of
    the driveline. Output: slip speed in rpm. In a run the actuator's torque is made of 1 ms
    straight lines, which is within 5e-5 of this.
    """
    path = driveline_matrices(parameters).path('clutch_torque', 'slip_speed')
    clutch_to_slip_rpm = StateSpace(path.a, path.b * wear_gain, path.c * RPM_PER_RAD_S, path.d)
    plant = series(actuator.dynamics(), clutch_to_slip_rpm)
    return sampled_behind_delay(plant, actuator.delay_substeps)


def sampled_loop(
    controller: StateSpace,
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
    wear_gain: float = 1.0,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> StateSpace:
    """
    Return L(z), the loop as it runs: a controller sampled at 10 ms, the hold and the delay.

    `controller` maps the error in rpm to the torque in N m; its states come first. Raise
    ParameterError when it is not sampled at 10 ms.
    """
    if controller.period_s != PERIOD_S:
        kind = f'sampled at {controller.period_s} s' if controller.period_s else 'continuous'
        raise ParameterError(f'controller is {kind}: discretise it at {PERIOD_S} s')
    return series(controller, sampled_plant(parameters, wear_gain, actuator))


class LoopCurve:
    """L(j omega) or L(exp(j omega T)) on a grid that is dense around the poles of L and of T."""

    def __init__(self, loop: ContinuousLoop | StateSpace) -> None:
        """Evaluate the loop on its grid, which contains the poles of T without a dead time."""
        if isinstance(loop, ContinuousLoop):
            system = loop.transfer_function.to_state_space()
            self._response = loop.response
        else:
            system = loop
            self._response = partial(frequency_response, loop)
        self._sampled = system.period_s is not None
        last = math.pi / system.period_s if system.period_s else _FASTEST_RAD_S
        poles = poles_rad_s(system)
        self._integrates = bool(np.min(np.abs(poles), initial=math.inf) < _SLOWEST_RAD_S)
        self.omega = _grid(np.concatenate([poles, poles_rad_s(close_loop(system))]), last)
        """Frequencies in rad/s, rising, (n,)."""
        self.values = self._response(self.omega)
        """Values of L at these frequencies, (n,) complex."""

    def at(self, omega: float) -> complex:
        """Return L at one frequency in rad/s."""
        return complex(self._response(np.array([omega]))[0])

    def crossings(self, measure: Measure) -> list[float]:
        """Return the frequencies in rad/s, rising, at which `measure` of L changes its sign."""
        signs = measure(self.values) > 0.0
        brackets = np.flatnonzero(signs[1:] != signs[:-1])

        def measured(omega: float) -> float:
            return self._measured(measure, omega)

        return [
            float(scipy.optimize.brentq(measured, *self.omega[i : i + 2], rtol=1e-12))
            for i in brackets
        ]

    def peak(self, measure: Measure) -> tuple[float, float]:
        """Return the maximum of `measure` of L over frequency, and its frequency in rad/s."""
        measured = measure(self.values)
        best = int(np.argmax(measured))
        highest, where = float(measured[best]), float(self.omega[best])
        inner = measured[1:-1]
        local = (inner >= measured[:-2]) & (inner >= measured[2:])
        for i in np.flatnonzero(local & (inner >= _NEAR_THE_PEAK * highest)):
            found = scipy.optimize.minimize_scalar(
                lambda x: -self._measured(measure, x),
                bounds=(self.omega[i], self.omega[i + 2]),
                method='bounded',
                options={'xatol': 1e-7 * self.omega[i]},
            )
            if -found.fun > highest:
                highest, where = -float(found.fun), float(found.x)
        return highest, where

    def critical_gains(self) -> list[float]:
        """Return every factor that puts L through -1: -1/L where L is real and negative."""
        crossings = self.crossings(lambda values: values.imag / np.abs(values))
        # L is real at rest and at half the sampling rate too, without a change of sign.
        at_rest = () if self._integrates else (0.0,)
        at_half_rate = self.omega[-1:] if self._sampled else ()
        values = [self.at(omega) for omega in (*crossings, *at_rest, *at_half_rate)]
        return [-1.0 / value.real for value in values if value.real < 0.0]

    def _measured(self, measure: Measure, omega: float) -> float:
        return float(measure(np.array([self.at(omega)]))[0])


def sensitivity(values: np.ndarray) -> np.ndarray:
    """Return |S| = 1/|1 + L| of values of L, elementwise."""
    return 1.0 / np.abs(1.0 + values)


def complementary(values: np.ndarray) -> np.ndarray:
    """Return |T| = |L/(1 + L)| of values of L, elementwise."""
    return np.abs(values / (1.0 + values))


def _grid(poles: np.ndarray, last: float) -> np.ndarray:
    near = np.concatenate([1.0 + _DISTANCES, 1.0 / (1.0 + _DISTANCES)])
    around = np.outer(np.abs(poles[np.isfinite(poles)]), near).ravel()
    inside = around[(around > _SLOWEST_RAD_S) & (around < last)]
    return np.unique(np.concatenate([np.geomspace(_SLOWEST_RAD_S, last, _GRID_POINTS), inside]))
