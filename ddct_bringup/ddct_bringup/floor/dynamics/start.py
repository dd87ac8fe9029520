# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""State of the plant at control start, from the recorded run that leads there."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.dynamics.off_going import OffGoing, off_going_of
from ddct_bringup.metrics.friction_work import friction_work
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.models.actuator import at_rest, lifted
from ddct_plant.scenario.initial_state import initial_request
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True, eq=False)
class ActuatorModel:
    """Delay and G_a as matrices over a period."""

    state_update: np.ndarray
    """Matrix from state and requests in effect to the next state, (n, n + inputs)."""
    nodes: np.ndarray
    """Matrix from state and requests in effect to the torque at the nodes, (11, n + inputs)."""
    delays: tuple[int, ...]
    """Age in periods of each request in effect, the earlier request first."""

    @classmethod
    def of(cls, settings: RunSettings) -> 'ActuatorModel':
        """Return the model of the scenario's actuator."""
        parameters = settings.scenario.actuator
        periods, late = divmod(parameters.delay_substeps, SUBSTEPS)
        delays = (periods + 1, periods) if late else (periods,)
        return cls(*lifted(parameters.dynamics(), late), delays)


@dataclass(frozen=True, eq=False)
class Start:
    """
    Signals up to control start, which are the same for every controller of `detailed`.

    In a gear shift these are those up to the start of the inertia phase, where feedback starts.
    """

    step: int
    """Step k of control start."""
    scored_from: int
    """Step from which metrics count: in a gear shift its start, else `step`."""
    state: np.ndarray
    """States w_m, w_p, w_r in rad/s and theta_sr in rad there, (4,)."""
    actuator: np.ndarray
    """State of G_a there, (n,)."""
    requests: np.ndarray
    """Requests in N m before control start, cut off below zero, (step,)."""
    before: float
    """Request in N m before t_0."""
    accelerations: np.ndarray
    """A_x in m/s^2 up to control start, (step + 1,)."""
    torsion_speeds: np.ndarray
    """Torsion speed w_sr in rad/s up to control start, (step + 1,)."""
    driving: np.ndarray
    """Driving force over the mass of the car in m/s^2 up to control start, (step + 1,)."""
    idle_integral: float
    """Greatest integral of idle control in N m that the engine can have there."""
    temperature_c: float
    """Temperature of the facing in degrees Celsius at control start; 20 for a linear clutch."""
    friction_work: float
    """Friction work in J between `scored_from` and `step`, zero but in a gear shift."""
    off_going: OffGoing | None = None
    """Off-going clutch of a gear shift; None in any other run."""

    @property
    def slip(self) -> float:
        """Slip speed w_d in rad/s at control start."""
        return float(self.state[0] - self.state[1])

    def request(self, step: int) -> float:
        """Return the request of a step before control start in N m; also before t_0."""
        return float(self.requests[step]) if step >= 0 else self.before


def start_of(settings: RunSettings, run: Trajectory) -> Start:
    """
    Return the state at control start of a recorded run, in a gear shift with the share 1.

    Raise ParameterError where the run ends before.
    """
    scored_from = settings.scenario.control_start_step
    step = ShiftCourse(run, scored_from).feedback_start if settings.shift else scored_from
    if run.steps < step and settings.shift:
        raise ParameterError(
            f'handover {settings.known.handover_name}: its share of C_fOL is never 1, so that '
            'there is no inertia phase, and no floor',
            key='handover',
        )
    if run.steps < step:
        raise ParameterError('the run ends before control start: there is no floor')
    requests = np.maximum(run.torque_request[:step], 0.0)
    before = max(initial_request(settings.known), 0.0)
    state = np.array(
        [
            run.engine_speed[step],
            run.primary_shaft_speed[step],
            run.wheel_speed[step],
            run.driveshaft_position[step],
        ]
    )
    if run.clutch_phase is not None and run.slip_speed[step] == 0.0:
        state[0] = state[1]
    temperature = run.clutch_temperature
    unforced = ActuatorModel.of(settings).delays[-1]
    return Start(
        step,
        scored_from,
        state,
        _actuator_state(settings, requests, before),
        requests,
        before,
        np.array(run.vehicle_accel[: step + 1]),
        np.array(run.driveshaft_speed[: step + 1]),
        driving_acceleration(settings.scenario, run.driveshaft_effort[: step + 1]),
        _idle_integral(settings, run.engine_speed[:step]),
        20.0 if temperature is None else float(temperature[step]),
        float(friction_work(run, scored_from) - friction_work(run, step)),
        off_going_of(settings, run, step, unforced) if settings.shift else None,
    )


def driving_acceleration(scenario: Scenario, torque: np.ndarray) -> np.ndarray:
    """Return the driving force over the mass in m/s^2 for driveshaft torques in N m, (...)."""
    return torque / (scenario.vehicle.wheel_radius_m * scenario.vehicle.mass_kg)


def _idle_integral(settings: RunSettings, engine_speed: np.ndarray) -> float:
    """Return the largest integral of idle control in N m after speeds in rad/s, (n,)."""
    limits = settings.scenario.engine_limits
    if limits is None:
        return 0.0
    below = np.maximum(limits.idle_rad_s - engine_speed, 0.0).sum()
    return min(float(limits.idle_integral_n_m * PERIOD_S * below), limits.idle_most_n_m)


def _actuator_state(settings: RunSettings, requests: np.ndarray, before: float) -> np.ndarray:
    """Return the state of G_a after the requests, (n,)."""
    model = ActuatorModel.of(settings)
    state = at_rest(settings.scenario.actuator.dynamics(), before)
    for step in range(len(requests)):
        ages = (step - delay for delay in model.delays)
        in_effect = [requests[age] if age >= 0 else before for age in ages]
        state = model.state_update @ np.array([*state, *in_effect])
    return state
