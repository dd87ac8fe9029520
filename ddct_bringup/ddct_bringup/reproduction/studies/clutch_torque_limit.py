# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lower limits of the sigmas in the thesis scenario for any control by clutch torque alone."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.reproduction.headless_run import THESIS_SCENARIO, thesis_run
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.thesis.table_5_1 import THESIS_TABLE
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    REQUEST,
    SLIP_SPEED,
    TORSION_SPEED,
    transmission_model,
)
from ddct_controllers.mpc.qp.backend import make_backend
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import steps_in
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.program.table import text_or_dash

PRINTED_STRAYS_RAD_S = (1.0, 2.0, 6.0)
"""Bounds of |w_d| after t_a in rad/s; the thesis does not print those of its runs."""
REGULARISATION = 1e-8
"""Weight as a share of the mean curvature: the last requests have no effect on the cost."""


@dataclass(frozen=True)
class Limit:
    """Smallest possible standard deviations, each by a separate quadratic program."""

    torsion_speed_std_rpm: float
    """Smallest standard deviation of w_sr in rpm."""
    acceleration_std_m_s2: float
    """Smallest standard deviation of A_x in m/s^2."""


def clutch_torque_limit() -> Study:
    """Return the limits at the engagement times of Table 5.1 and of the computed runs."""
    clutch_only = [row for row in THESIS_TABLE if row.controller != 'mpc4']
    rows = []
    for controller in (*(row.controller for row in clutch_only), 'hinf_sampled'):
        run = thesis_run(controller, 'detailed', 1.0)
        time = run.metrics['engagement_time_s']
        if time is None:
            raise DdctError(f'{controller} does not engage in the thesis scenario')
        strays = strays_after(run.trajectory, round(time, 2))
        rows.append(_cells(controller, time, strays, run.metrics))
    rows += [
        _cells(f'{row.label} as printed', row.engagement_time_s, strays, row.printed_values())
        for row in clutch_only
        for strays in PRINTED_STRAYS_RAD_S
    ]
    return Study(
        'Table 5.1 against the least that any clutch torque can give with the same t_a and stray',
        (
            'controller',
            't_a s',
            'w_d strays rad/s',
            'std w_sr rpm',
            'least',
            'std A_x m/s^2',
            'least',
        ),
        rows,
    )


def strays_after(run: Trajectory, engagement_time_s: float) -> float:
    """Return the largest |w_d| in rad/s from t_a to the end of the score window."""
    first = THESIS_SCENARIO.control_start_step + steps_in('engagement_time_s', engagement_time_s)
    last = steps_in('score_window_s', THESIS_SCENARIO.score_window_s[1])
    return float(np.abs(run.slip_speed[first : last + 1]).max())


def _cells(
    label: str, engagement_time_s: float, strays_rad_s: float, figures: Metrics
) -> tuple[str, ...]:
    bound = limit_at(round(engagement_time_s, 2), strays_rad_s)
    return (
        label,
        f'{engagement_time_s:.2f}',
        f'{strays_rad_s:.1f}',
        text_or_dash(figures['torsion_speed_std_rpm'], '.2f'),
        f'{bound.torsion_speed_std_rpm:.2f}',
        text_or_dash(figures['acceleration_std_m_s2'], '.3f'),
        f'{bound.acceleration_std_m_s2:.3f}',
    )


@cache
def limit_at(engagement_time_s: float, strays_rad_s: float) -> Limit:
    """
    Return the limits for slip that is positive until `engagement_time_s`, near zero after it.

    From then to the end of the score window it stays within `strays_rad_s` of zero. The whole
    future is known, C_m and C_load are those of the scenario, requests are constant over 10 ms and
    not negative, and act through delay and G_a from the state at control start.
    """
    start = THESIS_SCENARIO.control_start_step
    last = steps_in('score_window_s', THESIS_SCENARIO.score_window_s[1])
    prediction = _predict(thesis_run('pi', 'detailed', 1.0).trajectory, start, last)
    slip_free, slip_rows = prediction['slip']
    engaged = steps_in('engagement_time_s', engagement_time_s)
    before = np.arange(last - start + 1) < engaged
    # Requests act on the slip after two periods.
    lower = np.where(before, 0.0, -strays_rad_s)[2:] - slip_free[2:]
    upper = np.where(before, np.inf, strays_rad_s)[2:] - slip_free[2:]
    requests = last - start
    least = {}
    for name in ('torsion', 'acceleration'):
        free, rows = prediction[name]
        centred, centre = rows - rows.mean(axis=0), free - free.mean()
        hessian = centred.T @ centred
        hessian += REGULARISATION * np.trace(hessian) / requests * np.eye(requests)
        structure = QpStructure(hessian, np.vstack([np.eye(requests), slip_rows[2:]]))
        solution = make_backend('daqp', structure).solve(
            centred.T @ centre,
            np.concatenate([np.zeros(requests), lower]),
            np.concatenate([np.full(requests, np.inf), upper]),
        )
        if solution.status != 'solved':
            raise DdctError(f'limit at t_a {engagement_time_s:g} s: {solution.status}')
        least[name] = float(np.std(free + rows @ solution.z))
    return Limit(rpm_from_rad_s(least['torsion']), least['acceleration'])


def _predict(run: Trajectory, start: int, last: int) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """
    Return slip, w_sr and A_x over the steps `start`..`last` as free part and rows per request.

    Until `start` every controller of `detailed` leaves the plant to C_fOL, so any run can be used.
    """
    driveline, vehicle = THESIS_SCENARIO.driveline, THESIS_SCENARIO.vehicle
    model = transmission_model(driveline)
    speeds = run.engine_speed[0], run.primary_shaft_speed[0], run.wheel_speed[0]
    state = model.at_rest(speeds, run.driveshaft_position[0], run.torque_request[0])
    inputs = np.column_stack([run.torque_request, run.engine_torque, run.load_torque])
    for k in range(start):
        state = model.a @ state + model.b @ inputs[k]
    free, response = [state], [model.b[:, REQUEST]]
    known = [ENGINE_TORQUE, LOAD_TORQUE]
    for k in range(start, last):
        free.append(model.a @ free[-1] + model.b[:, known] @ inputs[k, known])
        response.append(model.a @ response[-1])
    shaft = np.zeros(len(state))
    damping = driveline.halfshaft_damping
    twisted = model.states.places('shaft_speed', 'wheel_speed', 'twist')
    stiffness = driveline.halfshaft_stiffness
    shaft[twisted] = driveline.gear.wheel_speed(damping), -damping, stiffness
    acceleration = vehicle.wheel_radius_m / driveline.vehicle_inertia * shaft
    load = vehicle.wheel_radius_m / driveline.vehicle_inertia * inputs[start : last + 1, 2]
    outputs = {
        'slip': (model.c[SLIP_SPEED], 0.0),
        'torsion': (model.c[TORSION_SPEED], 0.0),
        'acceleration': (acceleration, load),
    }
    return {
        name: (np.array(free) @ row - known_part, _delayed(np.array(response) @ row))
        for name, (row, known_part) in outputs.items()
    }


def _delayed(response: np.ndarray) -> np.ndarray:
    """Return (n, n - 1): column k is the response from step k on, delayed by one period."""
    none = np.zeros(len(response) - 1)
    return scipy.linalg.toeplitz(np.concatenate([[0.0], response[:-1]]), none)
