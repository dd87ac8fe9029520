# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Fits to many logs: their intervals cover the true values at the stated rate."""

import numpy as np
import pytest
from support.log_coverage import BEFORE, coverage
from support.logs import (
    NONE_LATE,
    constant_log,
    drag,
    hits,
    judged,
    log_of,
    require_delays_alone,
    speeds_late,
)
from support.other_car import SPEEDS, TRUE, drive

from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.logs.log import MeasuredLog
from ddct_plant.models.parameters import DrivelineParameters

START = DrivelineParameters()
"""Driveline that differs from the one of the logs."""
SEEDS = 12
DRIVES = {'corners on rows': 70, 'corners between rows': 70, 'late signal': 60}
"""Number of drives by kind."""


@pytest.fixture(scope='module')
def fit() -> LogFit:
    return fit_log(log_of(drive().noisy(0)), START, drag)


def test_intervals_of_95_percent_cover_the_true_values_at_that_rate(fit: LogFit) -> None:
    """The expected number of covering intervals is 91 of 96, with a deviation of 2."""
    true = DrivelineParameters.from_values(TRUE)
    held = [hits(fit_log(log_of(drive().noisy(seed)), true, drag)) for seed in range(SEEDS)]
    assert sum(map(sum, held)) >= 85
    assert all(len(each) == 8 for each in held)


def test_a_start_that_is_far_off_is_not_taken_for_noise() -> None:
    """The torques have 2 N m of noise, which hides the effects of J_p and c_sa: both are named."""
    fit = fit_log(log_of(drive(2).noisy(0, 2.0)), START, drag)
    assert {'engine_damping', 'halfshaft_stiffness'} <= set(fit.std)
    assert 'shaft_inertia' in fit.undetermined
    assert fit.values['total_ratio'] == pytest.approx(TRUE['total_ratio'], rel=0.01)
    for name in ('engine_inertia', 'engine_damping', 'halfshaft_stiffness', 'vehicle_inertia'):
        assert fit.values[name] == pytest.approx(TRUE[name], rel=0.1), name


def test_noise_of_the_torques_widens_the_intervals_and_they_still_cover_the_true_values(
    fit: LogFit,
) -> None:
    true = DrivelineParameters.from_values(TRUE)
    fits = [fit_log(log_of(drive().noisy(seed, 1.0)), true, drag) for seed in range(2)]
    held = [each for one in fits for each in hits(one)]
    assert sum(held) >= 0.8 * len(held)
    for one in fits:
        assert all(one.std[name] > fit.std[name] for name in one.std)
        assert one.values['shaft_inertia'] == pytest.approx(TRUE['shaft_inertia'], rel=0.05)
    # Left as it is, this noise pulls J_p by 1 and 4 %, and the deviation is below 2 %.
    assert np.mean([one.std['shaft_inertia'] for one in fits]) > 0.03


def test_a_log_at_constant_speed_shows_the_ratio_at_most() -> None:
    fit = fit_log(constant_log(), START, drag)
    assert set(fit.std) <= {'total_ratio', 'engine_damping', 'shaft_damping'}
    assert {'engine_inertia', 'halfshaft_stiffness', 'vehicle_inertia'} <= set(fit.undetermined)


@pytest.mark.parametrize(('kind', 'drives'), DRIVES.items(), ids=DRIVES)
def test_intervals_cover_the_true_values_as_often_as_before(
    pi_log: MeasuredLog, kind: str, drives: int
) -> None:
    """In 200 drives; tests/measured has a sample."""
    found, before = coverage(kind, range(drives), pi_log), BEFORE[kind]
    for (held, fitted), rate in zip((found.parameters, found.delays), before, strict=True):
        assert held >= rate * fitted
    assert found.parameters[1] == 8 * drives


@pytest.mark.parametrize(
    ('late', 'rows', 'true'),
    [
        (SPEEDS, 1, speeds_late(0.01)),
        (('clutch_torque',), 5, NONE_LATE | {'clutch_torque': 0.05}),
    ],
    ids=['speeds 10 ms', 'clutch torque 50 ms'],
)
def test_signals_that_are_rows_late_move_delays_and_not_parameters(
    pi_log: MeasuredLog, late: tuple[str, ...], rows: int, true: dict[str, float]
) -> None:
    """Other logs are in tests/measured."""
    require_delays_alone(pi_log, late, rows, true)


def test_noise_with_a_memory_and_noise_of_the_torques_are_not_taken_for_a_wrong_model() -> None:
    random = np.random.default_rng(2)
    for signals in (drive().noisy(1, 1.0), drive().noisy(2)):
        for name in SPEEDS:
            slow = np.convolve(random.standard_normal(len(drive().time_s)), 0.9 ** np.arange(40))
            signals[name] = signals[name] + 0.02 * slow[: len(drive().time_s)]
        assert judged(signals, drive().time_s)[2] == []
