# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Options of `least_jerk`, with the reason of each default."""

from dataclasses import dataclass

from ddct_plant.base.options import OptionGroup, option


@dataclass(frozen=True)
class LeastJerkOptions(OptionGroup):
    """Values of the section `controllers.least_jerk`."""

    jerk_m_s3: float = option(
        4.0,
        'jerk of a rigid car at which the planned torque changes, unless the lock would then be '
        'later than `latest_s`',
        'm/s^3',
        above=0.0,
        at_most=100.0,
    )
    refill_s: float = option(
        0.25,
        'time in which the planned torque would rise by all of that of constant slip once the '
        'torque phase of a gear shift has taken torque from the car; it rises no slower than it '
        'falls',
        's',
        at_least=0.05,
        at_most=10.0,
    )
    latest_s: float = option(
        0.6,
        'how much later than the reference ends the lock may be for less jerk',
        's',
        at_least=0.0,
        at_most=10.0,
    )
    least_s: float = option(
        0.8,
        'time that a plan takes at least from the start of feedback, so that a small slip does '
        'not change the torque quickly',
        's',
        at_least=0.0,
        at_most=10.0,
    )
    shift_s: float = option(
        1.1,
        'time that the plan of a gear shift takes at least from the start of feedback',
        's',
        at_least=0.0,
        at_most=10.0,
    )
    bandwidth_rad_s: float = option(
        12.0,
        'bandwidth of the feedback of the last rad/s of slip',
        'rad/s',
        at_least=1.0,
        at_most=15.0,
    )
    end_s: float = option(
        0.03,
        'time for which the surplus torque, with which the plates meet, would still fall',
        's',
        at_least=0.0,
        at_most=0.2,
    )
    smoothing_s: float = option(
        0.05,
        'time constant of the low-pass of the planned torque, against the twist of half-shafts',
        's',
        at_least=0.0,
        at_most=0.2,
    )
    observer_rad_s: float = option(
        5.0, 'bandwidth of the observer of the slip', 'rad/s', at_least=0.5, at_most=30.0
    )
    gain_drift: float = option(
        0.0004, 'drift of the estimated wear gain per period', at_least=0.0, at_most=0.1
    )
    offset_drift_n_m: float = option(
        0.15,
        'drift of the estimated offset of the clutch torque per period, at a torque of 100 N m',
        'N m',
        at_least=0.0,
        at_most=20.0,
    )
    most_torque_n_m: float | None = option(
        None,
        'highest torque of plates that slip, below what the clutch carries',
        'N m',
        otherwise='0.97 `friction.most_n_m`, in whole N m',
        above=0.0,
        at_most=1e5,
    )
    least_speed_rad_s: float | None = option(
        None,
        'engine speed that the clutch does not pull the engine below; none without engine limits',
        'rad/s',
        otherwise='0.85 `engine_limits.idle_rad_s`, in whole rad/s',
        at_least=0.0,
        at_most=500.0,
    )
    guard_s: float = option(
        0.15,
        'time constant with which the engine may approach that speed',
        's',
        at_least=0.05,
        at_most=2.0,
    )
    demand_periods: float = option(
        2.0,
        'periods of the locked driveline over which the engine torque follows the demand, in a '
        'run that starts with locked plates; 0 leaves the engine to the driver',
        at_least=0.0,
        at_most=3.0,
    )
