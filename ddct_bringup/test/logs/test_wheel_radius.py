# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The wheel radius of a log is V_x over w_r, with an interval that covers it."""

from pathlib import Path

import numpy as np
import pytest
from refusals import refused

from ddct_bringup.logs.log import MeasuredLog
from ddct_bringup.logs.wheel_radius import measured_radius
from ddct_plant.base.errors import DdctError

RADIUS_M = 0.298
ROWS, STEP_S = 600, 0.008


def log_of(seed: int, late_s: float = 0.0, memory: float = 0.0, noise: float = 1.0) -> MeasuredLog:
    """Return a drive with random acceleration; V_x is late, with noise that has a memory."""
    from scipy.signal import lfilter

    random = np.random.default_rng(seed)
    time_s = np.arange(ROWS) * STEP_S
    points = np.arange(0.0, 5.5, 0.24)
    rates = np.interp(time_s, points, random.uniform(-3.0, 8.0, len(points)))
    wheels = 15.0 + np.cumsum(rates) * STEP_S
    white = random.standard_normal(ROWS)
    error = lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], white)
    speeds = RADIUS_M * np.interp(time_s - late_s, time_s, wheels)
    signals = {
        'vehicle_speed': speeds + 0.05 * noise * error,
        'wheel_speed': wheels + 0.02 * noise * random.standard_normal(ROWS),
    }
    return MeasuredLog(Path('drive.csv'), '', time_s, signals)


@pytest.mark.parametrize(('late_s', 'memory'), [(0.0, 0.0), (0.03, 0.0), (0.0, 0.9)])
def test_intervals_of_95_percent_cover_the_true_radius_at_that_rate(
    late_s: float, memory: float
) -> None:
    """Of 200 white logs 190 are expected, with a deviation of 3; a memory costs some."""
    found = [measured_radius(log_of(seed, late_s, memory)) for seed in range(200)]
    held = [each is not None and each.lowest_m <= RADIUS_M <= each.highest_m for each in found]
    assert sum(held) >= (170 if memory else 181)
    widths = [each.highest_m - each.lowest_m for each in found if each]
    assert np.mean(widths) < 0.01 * RADIUS_M


def test_a_late_vehicle_speed_does_not_move_the_radius() -> None:
    found = measured_radius(log_of(3, late_s=0.04, noise=0.0))
    assert found is not None
    assert found.value_m == pytest.approx(RADIUS_M, rel=1e-4)


def test_samples_in_a_gap_of_the_wheel_speed_and_before_the_wheels_roll_are_left_out() -> None:
    log = log_of(1, noise=0.0)
    gap = slice(200, 240)
    log.signals['vehicle_speed'][gap] = 99.0
    log.signals['wheel_speed'][gap] = np.nan
    log.signals['vehicle_speed'][:50] = 2.0
    log.signals['wheel_speed'][:50] = 0.0
    log.signals['vehicle_speed'][50:57] = (
        np.nan
    )  # here the rate of w_r reaches into the rows before
    found = measured_radius(log)
    assert found is not None
    assert found.value_m == pytest.approx(RADIUS_M, rel=1e-9)
    assert found.lowest_m <= RADIUS_M <= found.highest_m


@pytest.mark.parametrize('lost', ['vehicle_speed', 'wheel_speed'])
def test_a_log_without_either_speed_or_at_a_standstill_gives_no_radius(lost: str) -> None:
    log = log_of(1)
    log.signals[lost][:] = 0.0 if lost == 'wheel_speed' else np.nan
    assert measured_radius(log) is None
    del log.signals[lost]
    assert measured_radius(log) is None


@pytest.mark.parametrize('factor', [3.6, -1.0, 1.0 / 3.6])
def test_a_radius_that_no_car_has_is_refused_with_both_signals(factor: float) -> None:
    log = log_of(1)
    log.signals['vehicle_speed'] *= factor
    with refused(DdctError, 'columns.vehicle_speed', place='drive.csv'):
        measured_radius(log)
