# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals that the page draws, one chart each."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.zero_slip import LOCKED
from ddct_plant.base.units import rpm_from_rad_s


@dataclass(frozen=True)
class ChartSignal:
    """Signal of one chart."""

    key: str
    title: str
    symbol: str
    unit: str
    meaning: str
    """Meaning of the signal: where it is measured, and its sign."""
    values: Callable[[Trajectory], np.ndarray]
    """Function that returns the signal, (N+1,), in the unit."""
    thin: Callable[[Trajectory], np.ndarray] | None = None
    """Function that returns a second signal, (N+1,), in the unit, whose line is thin."""
    thin_name: str = ''
    """Name of the second signal."""

    @property
    def thin_key(self) -> str:
        """Name of the column of the second signal."""
        return f'{self.key}_thin'


SPEEDS = ChartSignal(
    'w_m',
    'Speeds of engine and primary shaft',
    'w_m',
    'rpm',
    'speed of the engine. A thin line is w_p, that of the primary shaft.',
    lambda run: rpm_from_rad_s(run.engine_speed),
    lambda run: rpm_from_rad_s(run.engine_speed - run.slip_speed),
    'w_p',
)

CHART_SIGNALS = (
    SPEEDS,
    ChartSignal(
        'w_d',
        'Slip speed of the clutch',
        'w_d',
        'rpm',
        'speed of the engine less that of the primary shaft. Above zero the engine is faster.',
        lambda run: rpm_from_rad_s(run.slip_speed),
    ),
    ChartSignal(
        'C_f_request',
        'Clutch torque: requested',
        'C_f',
        'N m',
        'what the controller asks for. It acts from the engine on the shaft.',
        lambda run: run.torque_request,
    ),
    ChartSignal(
        'C_f_actuator',
        'Clutch torque: from the actuator',
        'C_f',
        'N m',
        'what the actuator gives, after its delay and its dynamics.',
        lambda run: run.at_tick('actuator_torque'),
    ),
    ChartSignal(
        'C_f_clutch',
        'Clutch torque: after wear',
        'C_f',
        'N m',
        'what the clutch can transmit: that of the actuator times the wear gain.',
        lambda run: run.at_tick('clutch_torque'),
    ),
    ChartSignal(
        'C_m',
        'Engine torque: demand and delivered',
        'C_m',
        'N m',
        'above zero it drives the engine. What it lacks of the demand C_dem is shaded.',
        lambda run: run.engine_torque,
    ),
    ChartSignal(
        'A_x',
        'Acceleration of the vehicle',
        'A_x',
        'm/s²',
        'above zero the car gets faster.',
        lambda run: run.vehicle_accel,
    ),
    ChartSignal(
        'error',
        'Slip error',
        'e',
        'rpm',
        'reference less w_d. Below zero the clutch slips more than it should.',
        lambda run: rpm_from_rad_s(run.at_tick('slip_reference') - run.slip_speed),
    ),
    ChartSignal(
        'w_sr',
        'Twist rate of the driveshaft',
        'w_sr',
        'rpm',
        'speed of the inner end of the driveshaft less that of the wheel. Above zero it winds up.',
        lambda run: rpm_from_rad_s(run.driveshaft_speed),
    ),
)
"""Signals of every run."""


def capacity(run: Trajectory, side: str = '') -> np.ndarray:
    """
    Return the friction torque capacity of a clutch in N m: the static capacity while locked.

    `side` is the prefix of its signals. NaN where it is not known, as for a log.
    """
    phase = getattr(run, f'{side}clutch_phase')
    if phase is None:
        return np.full(run.steps + 1, np.nan)
    static, kinetic = (run.at_tick(f'{side}clutch_{name}') for name in ('static_torque', 'torque'))
    return np.where(phase == LOCKED, static, kinetic)


TRANSMITTED = ChartSignal(
    'C_f_transmitted',
    'Clutch torque: transmitted',
    'C_f',
    'N m',
    'what passes through the plates. A thin line is what they can carry.',
    lambda run: run.primary_shaft_effort,
    capacity,
    'capacity',
)

CLUTCH_SIGNALS = (
    TRANSMITTED,
    ChartSignal(
        'friction_energy',
        'Friction energy of the clutch',
        'E_f',
        'kJ',
        'heat of the clutch since the start of the run.',
        lambda run: np.cumsum(run.friction_work) / 1e3,
    ),
    ChartSignal(
        'temperature',
        'Temperature of the facing',
        'T_f',
        '°C',
        'temperature of the facing.',
        lambda run: run.clutch_temperature,
    ),
)
"""Signals of runs with a stick-slip clutch."""


SENSOR_SIGNALS = (
    ChartSignal(
        'w_d_sensed',
        'Slip speed as measured, less the true one',
        'w_d',
        'rpm',
        'above zero the sensor reads too much.',
        lambda run: rpm_from_rad_s(run.sensed_slip_speed - run.slip_speed),
    ),
)
"""Signals of runs with sensors."""


WHEEL_TORQUE = ChartSignal(
    'driveshaft_torque',
    'Torque of the driveshaft',
    'C_s',
    'N m',
    'at the wheels. Above zero it drives them.',
    lambda run: run.driveshaft_effort,
)

LOG_SIGNALS = (
    ChartSignal(
        'V_x',
        'Speed of the vehicle',
        'V_x',
        'km/h',
        'above zero the car goes forward.',
        lambda run: 3.6 * run.vehicle_speed,
    ),
    TRANSMITTED,
    WHEEL_TORQUE,
)
"""Signals of logs of a car, and of the runs compared with them."""

SHOWN_FIRST = (
    'w_m',
    'w_d',
    'C_f_request',
    'C_f_actuator',
    'C_f_clutch',
    'C_f_transmitted',
    'C_m',
    'A_x',
)
"""Keys of the charts that come first, in this order: speeds, slip, torques, acceleration."""
