# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""LQ control with the integral of the slip error, a Kalman filter and a Smith predictor."""

import math

import numpy as np

from ddct_controllers.interface import ControllerContext, ControllerSpec
from ddct_controllers.linear import LinearController
from ddct_controllers.mpc.estimate.observer import NoiseLevels, riccati
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission
from ddct_plant.base.options import Option
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.base.units import RAD_S_PER_RPM
from ddct_plant.linear.delayed_input import acting_inputs, with_waiting_inputs
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.parameters import DrivelineParameters

NAME = 'lqi'
NO_GAIN = f'{NAME}: no gain for this driveline (%s)'
OPTIONS = {
    'natural_frequency_rad_s': Option(
        4.0,
        'frequency of the double pole on a rigid driveline without lag',
        'rad/s',
        at_least=1.0,
        at_most=8.0,
    ),
}
"""Options of the controller; tested to be stable at wear gains from 0.7 to 1.3."""


def noise_levels(friction: FrictionParameters) -> NoiseLevels:
    """
    Return the noise levels of the filter: both torques to a tenth of the clutch's working torque.

    With less the loop is fragile.
    """
    tenth = friction.working_torque / 10.0
    return NoiseLevels(engine_torque_n_m=tenth, clutch_torque_n_m=tenth)


def lqi_model(
    driveline: DrivelineParameters,
    actuator: ActuatorParameters,
    noise: NoiseLevels,
    natural_frequency_rad_s: float,
) -> StateSpace:
    """
    Return the controller from slip error in rpm to torque in N m, sampled.

    States: the filter's prediction of x (n,), the integral of the error in rad, and the d requests
    that whole periods of delay keep back, the oldest first. With y = -e the deviation of the slip
    from its reference, and d = 1,

        filtered: x_(k|k) = x_(k|k-1) + l (y_k - c x_(k|k-1)),
        predicted over the delay: x_(k+1|k) = a x_(k|k) + b u_(k-1), q_(k+1) = q_k + T e_k,
        fed back: u_k = -K [x_(k+1|k), q_(k+1)].

    u_k reaches the actuator in period k + d, whose state is known exactly but for noise. So K is
    that of a plant without the delay: the Smith predictor in its state form, which the form with
    two plant models is not fit for, as this plant integrates. Over further periods of delay the
    error is predicted too, as -c x; a part of a period is in the plant.
    """
    delayed, late = divmod(actuator.delay_substeps, SUBSTEPS)
    plant = _plant(driveline, actuator.dynamics(), late)
    gain = _feedback_gain(plant, driveline, natural_frequency_rad_s)
    filter_gain = _filter_gain(plant, driveline, noise)
    states = len(plant.a)
    integral, first = states, states + 1
    size = first + delayed
    a, b = np.zeros((size, size)), np.zeros((size, 1))
    filtered = np.eye(states) - filter_gain @ plant.c
    a[:states, :states] = plant.a @ filtered
    b[:states] = -plant.a @ filter_gain * RAD_S_PER_RPM
    a[integral, integral] = 1.0
    b[integral] = PERIOD_S * RAD_S_PER_RPM
    if not delayed:
        c, d = -gain[:states] @ filtered, gain[:states] @ filter_gain * RAD_S_PER_RPM
        c, d = np.append(c, -gain[integral])[None], d[None]
        a[:states] += plant.b @ c
        b[:states] += plant.b @ d
        return StateSpace(a, b, c, d, PERIOD_S)
    a[:states, first] = plant.b[:, 0]
    ahead_a, ahead_b = a[:first], b[:first]
    step, held = _with_integral(plant)
    for request in range(first + 1, size):
        ahead_a, ahead_b = step @ ahead_a, step @ ahead_b
        ahead_a[:, request] += held[:, 0]
    a[first:-1, first + 1 :] = np.eye(delayed - 1)
    a[-1] = -gain @ ahead_a
    b[-1] = -gain @ ahead_b
    return StateSpace(a, b, a[-1:], b[-1:], PERIOD_S)


def slip_model(parameters: DrivelineParameters) -> StateSpace:
    """
    Return the driveline of Section 1.5 in x = [w_d, w_sr, theta_sr], y = w_d, u the torques.

    u = [C_m, C_f, C_load] in N m.

    c_m and c_prim are left out: they act on absolute speeds, on which slip does not depend, and
    only move a pole from 0 to -0.007 1/s. Their drag is a constant torque to this model.
    """
    p = parameters
    damping, stiffness = p.halfshaft_damping, p.halfshaft_stiffness
    to_shaft = 1.0 / p.gear.across(p.shaft_inertia)
    to_torsion = p.gear.wheel_speed(to_shaft) + 1.0 / p.vehicle_inertia
    a = [
        [0.0, damping * to_shaft, stiffness * to_shaft],
        [0.0, -damping * to_torsion, -stiffness * to_torsion],
        [0.0, 1.0, 0.0],
    ]
    b = [
        [1.0 / p.engine_inertia, -1.0 / p.engine_inertia - 1.0 / p.shaft_inertia, 0.0],
        [0.0, to_shaft, 1.0 / p.vehicle_inertia],
        [0.0, 0.0, 0.0],
    ]
    return StateSpace(np.array(a), np.array(b), np.eye(1, 3), np.zeros((1, 3)))


def _plant(driveline: DrivelineParameters, actuator: StateSpace, late: int) -> StateSpace:
    """
    Return G_a and the slip model behind a delay of `late` ms, sampled: N m to w_d in rad/s.

    With such a delay the request before is its last state.
    """
    slip = slip_model(driveline)
    clutch = slip.b[:, 1:2]
    a = np.block(
        [[slip.a, clutch @ actuator.c], [np.zeros((len(actuator.a), len(slip.a))), actuator.a]]
    )
    b = np.vstack([np.zeros((len(slip.a), 1)), actuator.b])
    continuous = StateSpace(a, b, np.eye(len(a)), np.zeros((len(a), 1)))
    sampled = discretise_zoh(continuous, PERIOD_S)
    a, b = with_waiting_inputs(sampled.a, acting_inputs(continuous, late), periods=0)
    return StateSpace(a, b, np.eye(1, len(a)), np.zeros((1, 1)), PERIOD_S)


def _with_integral(plant: StateSpace) -> tuple[np.ndarray, np.ndarray]:
    """Return a (n + 1, n + 1) and b (n + 1, 1) of the plant and the integral of its error."""
    states = len(plant.a)
    a = np.zeros((states + 1, states + 1))
    a[:states, :states], a[states, states] = plant.a, 1.0
    a[states, :states] = -PERIOD_S * plant.c[0]
    return a, np.append(plant.b[:, 0], 0.0)[:, None]


def _feedback_gain(
    plant: StateSpace, driveline: DrivelineParameters, natural_frequency_rad_s: float
) -> np.ndarray:
    """
    Return K (n + 1,) that minimises the sum of u^2 + q_y w_d^2 + q_q q^2, q the error's integral.

    On the rigid driveline without lag, dw_d/dt = -g u, q_y = 2 (w/g)^2 and q_q = (w^2/g)^2 give
    the closed-loop polynomial (s + w)^2.
    """
    states = len(plant.a)
    a, b = _with_integral(plant)
    slip_gain = RigidTransmission(driveline).slip_gain
    weights = np.zeros((states + 1, states + 1))
    weights[:states, :states] = (
        2.0 * (natural_frequency_rad_s / slip_gain) ** 2 * (plant.c.T @ plant.c)
    )
    weights[states, states] = (natural_frequency_rad_s**2 / slip_gain) ** 2
    cost = riccati(a, b, weights, np.eye(1), NO_GAIN)
    return np.linalg.solve(1.0 + b.T @ cost @ b, b.T @ cost @ a)[0]


def _filter_gain(
    plant: StateSpace, driveline: DrivelineParameters, noise: NoiseLevels
) -> np.ndarray:
    """
    Return the stationary Kalman gain l (n, 1) for the levels of noise.

    Torque noise is held over a period; two measured speeds make the slip.
    """
    torques = discretise_zoh(slip_model(driveline), PERIOD_S).b
    levels = noise.engine_torque_n_m, noise.clutch_torque_n_m, noise.load_torque_n_m
    driven = np.zeros((len(plant.a), 3))
    driven[: len(torques)] = torques * levels
    error = (math.sqrt(2.0) * noise.speed_rad_s) ** 2
    covariance = riccati(plant.a.T, plant.c.T, driven @ driven.T, np.array([[error]]), NO_GAIN)
    innovation = plant.c @ covariance @ plant.c.T + error
    return covariance @ plant.c.T / innovation


def _make(context: ControllerContext) -> LinearController:
    scenario = context.settings.scenario
    noise = noise_levels(scenario.friction)
    driveline, actuator = scenario.controlled_driveline, scenario.actuator
    return LinearController(lqi_model(driveline, actuator, noise, **context.gains))


SPEC = ControllerSpec(NAME, _make, OPTIONS)
