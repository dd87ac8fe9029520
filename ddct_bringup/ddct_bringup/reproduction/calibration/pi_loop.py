"""Stability of the PI's slip loop: the linear sampled loop with the actuator and its delay."""

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import StateSpace, discretise_zoh
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR


def pi_growth_rate(
    parameters: DrivelineParameters, proportional_gain: float, integral_gain: float
) -> float:
    """
    Return the growth rate in 1/s of the loop's slowest-decaying motion; positive is unstable.

    State: driveline and actuator sampled at 10 ms, the delayed request, the integral of e. Load
    constant, clutch new, no saturation; u = -(K_p e + K_i integral of e) with e = -w_d in rpm.
    """
    plant = discretise_zoh(_plant(parameters), PERIOD_S)
    states = len(plant.a)
    error_rpm = -RPM_PER_RAD_S * plant.c[0]
    loop = np.zeros((states + 2, states + 2))
    loop[:states, :states] = plant.a
    loop[:states, states] = plant.b[:, 0]
    loop[states, :states] = -proportional_gain * error_rpm
    loop[states, states + 1] = -integral_gain
    loop[states + 1, :states] = PERIOD_S * error_rpm
    loop[states + 1, states + 1] = 1.0
    return float(np.log(np.max(np.abs(np.linalg.eigvals(loop)))) / PERIOD_S)


def _plant(parameters: DrivelineParameters) -> StateSpace:
    """Return the request after its delay to slip speed: the actuator, then the driveline."""
    driveline, actuator = driveline_matrices(parameters), ACTUATOR.to_state_space()
    a = np.block(
        [
            [driveline.a, driveline.b[:, 1:2] @ actuator.c],
            [np.zeros((len(actuator.a), len(driveline.a))), actuator.a],
        ]
    )
    b = np.vstack([np.zeros((len(driveline.a), 1)), actuator.b])
    c = np.hstack([driveline.c[:1], np.zeros((1, len(actuator.a)))])
    return StateSpace(a, b, c, np.zeros((1, 1)))
