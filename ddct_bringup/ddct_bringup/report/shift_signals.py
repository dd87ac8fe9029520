# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals of gear shifts that the page draws besides those of every run."""

import numpy as np

from ddct_bringup.report.chart_signals import WHEEL_TORQUE, ChartSignal, capacity
from ddct_plant.base.units import rpm_from_rad_s

OFF_GOING = 'off_going_'
"""Prefix of the signals of the off-going clutch."""
SHIFT_SIGNALS = (
    WHEEL_TORQUE,
    ChartSignal(
        'handover_share',
        'Share of the on-coming clutch',
        's_h',
        '',
        'share of C_fOL that the handover gives the on-coming clutch. Feedback starts at 1.',
        lambda run: run.handover_share,
    ),
    ChartSignal(
        'C_1_request',
        'Off-going clutch torque: requested',
        'C_1',
        'N m',
        'what the handover asks of the off-going clutch.',
        lambda run: run.off_going_torque_request,
    ),
    ChartSignal(
        'C_1_transmitted',
        'Off-going clutch torque: transmitted',
        'C_1',
        'N m',
        'what passes through its plates. Below zero it brakes the car. A thin line is what they '
        'can carry.',
        lambda run: run.off_going_transmitted_torque,
        lambda run: capacity(run, OFF_GOING),
        'capacity',
    ),
    ChartSignal(
        'w_d1',
        'Slip speed of the off-going clutch',
        'w_d1',
        'rpm',
        'speed of the engine less that of the off-going shaft. Above zero the engine flares.',
        lambda run: rpm_from_rad_s(run.off_going_slip_speed),
    ),
    ChartSignal(
        'torque_cut',
        'Torque cut of the engine',
        'C_cut',
        'N m',
        "what the handover takes off the driver's demand.",
        # Without a cut there is no chart.
        lambda run: np.where(run.torque_cut.any(), run.torque_cut, np.nan),
    ),
    ChartSignal(
        'friction_energy_1',
        'Friction energy of the off-going clutch',
        'E_f1',
        'kJ',
        'heat of the off-going clutch since the start of the run.',
        lambda run: np.cumsum(run.off_going_friction_work) / 1e3,
    ),
    ChartSignal(
        'temperature_1',
        'Temperature of the off-going facing',
        'T_f1',
        '°C',
        'temperature of its facing.',
        lambda run: run.off_going_clutch_temperature,
    ),
)
"""Signals of gear shifts; those of every run are of the on-coming clutch."""
