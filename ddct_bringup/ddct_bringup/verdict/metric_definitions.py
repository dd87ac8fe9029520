# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table of the metrics of a run: name, unit, format, meaning, and why one may be undefined."""

from ddct_plant.program.table import PURE, Quantity

NO_CROSSING = 'after control start w_d never changed its sign, or it was zero there'
NO_LOCKUP = (
    'after control start the plates never came together, or they were together there already, or '
    'the bag was recorded before locks had a slip acceleration'
)
NO_WINDOW = 'the run ends before the score window does, or a value is not finite'
NOT_FINITE = 'a value is not finite'
NO_TIMING = 'there is no timing.json'
VDV_WEIGHTING = 'W_d of ISO 2631-1 (x axis), bilinear at 100 Hz, without its 100 Hz upper limit'
"""
Frequency weighting of the vibration dose value.

The omitted 100 Hz limit is above 50 Hz, the highest frequency in a 100 Hz recording.
"""

TABLE_5_1 = (
    Quantity(
        'engagement_time_s',
        't_a',
        's',
        '.3f',
        't_a, control start to the first change of sign of w_d; of plates that stick, to the '
        'exact instant at which they first lock or pass through zero',
        NO_CROSSING,
    ),
    Quantity(
        'torsion_speed_std_rpm',
        'std w_sr',
        'rpm',
        '.3f',
        'standard deviation of w_sr over the score window',
        NO_WINDOW,
    ),
    Quantity(
        'acceleration_std_m_s2',
        'std A_x',
        'm/s^2',
        '.3f',
        'standard deviation of A_x over the score window',
        NO_WINDOW,
    ),
)
"""Metrics that the thesis prints in Table 5.1."""
FURTHER = (
    Quantity(
        'slip_rmse_rpm',
        'RMSE w_d',
        'rpm',
        '.2f',
        'root mean square of reference less w_d over the score window',
        NO_WINDOW,
    ),
    Quantity('slip_final_rpm', 'final w_d', 'rpm', '.2f', 'w_d at the end of the run', NOT_FINITE),
    Quantity(
        'peak_jerk_m_s3',
        'peak jerk',
        'm/s^3',
        '.2f',
        'largest jerk from control start to the end of the run, A_x through a 20 Hz low-pass '
        'without delay',
        NO_WINDOW,
    ),
    Quantity(
        'vdv_m_s1_75',
        'VDV',
        'm/s^1.75',
        '.3f',
        f'vibration dose over the score window, weighted by {VDV_WEIGHTING}',
        NO_WINDOW,
    ),
    Quantity(
        'weighted_acceleration_m_s2',
        'weighted A_x',
        'm/s^2',
        '.3f',
        'r.m.s. of A_x over the score window, weighted by W_d of ISO 2631-1',
        NO_WINDOW,
    ),
    Quantity(
        'friction_energy_j',
        'friction energy',
        'J',
        '.0f',
        'friction work of the clutch, whole run',
        NOT_FINITE,
    ),
    Quantity(
        'lockup_slip_acceleration_rad_s2',
        'dw_d/dt at lock-up',
        'rad/s^2',
        '.2f',
        'slope of w_d where it first changes its sign; of plates that stick, the exact one just '
        'before the first lock',
        NO_LOCKUP,
    ),
    Quantity(
        'torque_total_variation_n_m',
        'variation C_f',
        'N m',
        '.0f',
        'sum of all changes of the torque request, whole run',
        NOT_FINITE,
    ),
    Quantity('steps', 'steps', PURE, '.0f', 'length of the run in periods of 10 ms'),
)
"""Metrics that are neither in Table 5.1 nor computed from `timing.json`."""
METRICS = {
    figure.key: figure
    for figure in (
        *TABLE_5_1,
        *FURTHER,
        Quantity(
            'missed_steps',
            'missed',
            PURE,
            'd',
            'steps that went on without a reply',
            NO_TIMING,
        ),
    )
}
"""Metrics shown in tables, by name."""
