# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The loop opened at the slip error, L = G_c G_a P_2 30/pi K_usura: continuous or sampled."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.design.delayed_input import sampled_behind_delay
from ddct_controllers.design.state_space import series
from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.driveline_model import clutch_to_slip, driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR

IDENTIFIED_DRIVELINE = DrivelineParameters()
WEAR_RANGE = (0.7, 1.3)
"""Ends of the range of K_usura, without unit: inequality (3.2), Table 5.2."""


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
                f'loop: a delay of {self.delay_s:g} s has no state space: leave it out, or sample',
                key='delay',
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
    require_sampled(controller)
    return series(controller, sampled_plant(parameters, wear_gain, actuator))


def require_sampled(controller: StateSpace) -> None:
    """Raise ParameterError when a controller is not sampled at 10 ms."""
    if controller.period_s != PERIOD_S:
        kind = f'sampled at {controller.period_s} s' if controller.period_s else 'continuous'
        raise ParameterError(f'controller is {kind}: discretise it at {PERIOD_S} s')
