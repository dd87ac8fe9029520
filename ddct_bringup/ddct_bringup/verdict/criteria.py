# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table of the criteria of an engagement: how each is computed for a run, and its unit."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ddct_bringup.verdict.friction_work import LEAST_SLIP_RPM, slips_at, work_over_least
from ddct_bringup.verdict.judged_run import JudgedRun, Values
from ddct_bringup.verdict.mean_motion import mean_acceleration, mean_jerk, mean_negative_jerk
from ddct_bringup.verdict.metric_definitions import METRICS, NO_WINDOW
from ddct_bringup.verdict.vibration import SHORTEST_JUDDER_S, torque_dip
from ddct_plant.program.table import Quantity

AXIS_FACTOR = 1.4
"""Factor of longitudinal vibration in a dose for health (2002/44/EC, Annex, part B, 1)."""


@dataclass(frozen=True)
class Criterion(Quantity):
    """One criterion of an engagement; its key is its name in `verdict`."""

    value: Callable[[JudgedRun], Values | None] = field(kw_only=True)
    """Function that computes the criterion; None or not finite where it is undefined."""
    exists: Callable[[JudgedRun], Any] = field(default=lambda run: True, kw_only=True)
    """
    Whether the criterion is defined for the run's plant, (R,) for many runs. No limit applies
    where it is not.
    """
    metric: str = field(default='', kw_only=True)
    """Key of the metric of `scores.json` that is the same quantity; empty for none."""


def _daily_dose(run: JudgedRun) -> Values | None:
    dose = run.strongest[1]
    return None if dose is None else AXIS_FACTOR * dose * run.engagements_a_day**0.25


def _peak_temperature(run: JudgedRun) -> Values | None:
    temperature = run.trajectory.clutch_temperature
    return None if temperature is None else np.max(temperature)


def _peak_acceleration(run: JudgedRun) -> Values:
    return np.max(np.abs(run.acceleration), axis=-1, initial=-math.inf)


def _criterion(
    name: str,
    unit: str,
    value: Callable[[JudgedRun], Values | None],
    meaning: str,
    undefined: str,
    **further: Any,
) -> Criterion:
    symbol = name.replace('_', ' ')
    return Criterion(name, symbol, unit, '.4g', meaning, undefined, value=value, **further)


def _metric(name: str, key: str) -> Criterion:
    """Return the criterion that has the value of a metric."""
    metric = METRICS[key]
    return _criterion(
        name,
        metric.unit,
        lambda run: run.metrics[key],
        metric.meaning,
        metric.undefined,
        metric=key,
    )


def _sticks(run: JudgedRun) -> bool:
    return run.trajectory.clutch_phase is not None


_NO_LOCK = 'the clutch is linear, or never locked after control start'
_NOT_TOGETHER = 'the plates never came together after control start'
_NOTHING = 'the run ends before control start'
_BELOW_1_S = 'the run ends less than 1 s after control start'
"""Reasons why a criterion is undefined."""

CRITERIA = (
    _criterion(
        'time_to_lock',
        's',
        lambda run: run.time_to_lock_s,
        'control start to the first lock',
        f'{_NO_LOCK}, or was locked there',
        exists=_sticks,
    ),
    _metric('engagement_time', 'engagement_time_s'),
    _metric('peak_jerk', 'peak_jerk_m_s3'),
    _criterion(
        'mean_jerk',
        'm/s^3',
        lambda run: mean_jerk(run.acceleration),
        "largest of the jerk's means over 1 s after control start",
        _BELOW_1_S,
    ),
    _criterion(
        'mean_negative_jerk',
        'm/s^3',
        lambda run: mean_negative_jerk(run.acceleration),
        "most negative of the jerk's means over 1 s after control start",
        _BELOW_1_S,
    ),
    _criterion(
        'mean_acceleration',
        'm/s^2',
        lambda run: mean_acceleration(run.acceleration),
        'largest mean of A_x over 2 s after control start',
        'the run ends less than 2 s after control start',
    ),
    _criterion(
        'peak_acceleration',
        'm/s^2',
        _peak_acceleration,
        'largest magnitude of A_x after control start',
        _NOTHING,
    ),
    _criterion(
        'weighted_acceleration',
        'm/s^2',
        lambda run: run.strongest[0],
        'largest r.m.s. of A_x, weighted by W_d of ISO 2631-1, over any stretch after control '
        'start as long as the score window',
        NO_WINDOW,
    ),
    _criterion(
        'daily_vibration_dose',
        'm/s^1.75',
        _daily_dose,
        '1.4 times the largest vibration dose over any such stretch, for all engagements of a day',
        NO_WINDOW,
    ),
    _metric('friction_energy', 'friction_energy_j'),
    _criterion(
        'friction_work_over_least',
        '1',
        lambda run: work_over_least(run.trajectory, run.control_start, run.plant),
        'friction work after control start over the least for a rigid car, '
        'J_m J_eq/(J_m + J_eq) w_d^2/2 with w_d at control start',
        f'the slip at control start is below {LEAST_SLIP_RPM:g} rpm, or the plant is not known',
        exists=lambda run: slips_at(run.trajectory, run.control_start),
    ),
    _criterion(
        'peak_temperature',
        'degC',
        _peak_temperature,
        'highest temperature of the facing',
        'the clutch is linear',
        exists=_sticks,
    ),
    _metric('slip_acceleration_at_lock', 'lockup_slip_acceleration_rad_s2'),
    _criterion(
        'releases_after_lock',
        '1',
        lambda run: run.releases,
        'how often the plates part again',
        _NO_LOCK,
        exists=_sticks,
    ),
    _criterion(
        'judder',
        'rpm',
        lambda run: run.judder,
        'r.m.s. of w_sr from 2 to 20 Hz from the first to the last sample of slipping after '
        'control start, of a linear clutch before t_a',
        f'the clutch slips for less than {SHORTEST_JUDDER_S:g} s after control start',
        exists=lambda run: run.slips_for_judder,
    ),
    _criterion(
        'shuffle_amplitude',
        'rpm',
        lambda run: run.shuffle[0],
        'largest magnitude of w_sr once the plates are together',
        _NOT_TOGETHER,
    ),
    _criterion(
        'shuffle_decay',
        's',
        lambda run: run.shuffle[1],
        'from there until w_sr stays below 1/e of it',
        f'{_NOT_TOGETHER}, or w_sr has not decayed when the run ends',
    ),
    _criterion(
        'torque_dip',
        'N m',
        lambda run: torque_dip(run.driveshaft_torque),
        "largest fall of the driveshaft's torque after control start",
        _NOTHING,
    ),
    _metric('request_variation', 'torque_total_variation_n_m'),
    _metric('deadline_misses', 'missed_steps'),
)

CRITERION_UNITS = {criterion.key: criterion.unit for criterion in CRITERIA}


def criterion_values(run: JudgedRun) -> dict[str, float | int | None]:
    """Return the value of every criterion by name, None where it is not defined."""
    return {key: finite(value) for key, value in raw_criteria(run).items()}


def raw_criteria(run: JudgedRun) -> dict[str, Values | None]:
    """Return the values of all criteria by name, without conversion to Python numbers."""
    with np.errstate(all='ignore'):  # what is not finite becomes None
        return {criterion.key: criterion.value(run) for criterion in CRITERIA}


def existing(run: JudgedRun) -> dict[str, Any]:
    """Return by criterion whether it is defined for the run's plant, (R,) for many runs."""
    return {criterion.key: criterion.exists(run) for criterion in CRITERIA}


def finite(value: Any) -> float | int | None:
    """Return the value as a Python number, None where it is not finite."""
    if value is None or not math.isfinite(value):
        return None
    return value if isinstance(value, int) else float(value)
