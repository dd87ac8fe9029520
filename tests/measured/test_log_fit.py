# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A fit to a log finds the car, within its intervals, and names parameters without information."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.logs import constant_log, drag, hits, log_of
from support.other_car import LASTS_S, NOISE_RAD_S, ROLLING_N_M, SPEEDS, TRUE, drive
from support.runs import plan, record

from ddct_bringup.identification.from_log.command import NEEDED
from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.prediction import predict
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.identification.from_log.stretches import (
    resolution,
    stretches_of,
    white_noise,
)
from ddct_bringup.logs.columns import TIME, own_columns
from ddct_bringup.logs.log import read_log
from ddct_plant.base.errors import DdctError
from ddct_plant.models.parameters import DrivelineParameters

pytestmark = pytest.mark.slow

START = DrivelineParameters()
"""Driveline that differs from the one of the logs."""


@pytest.fixture(scope='module')
def fit() -> LogFit:
    return fit_log(log_of(drive().noisy(0)), START, drag)


def test_every_parameter_of_a_car_of_other_code_is_found_from_another_start(fit: LogFit) -> None:
    assert fit.undetermined == ()
    assert fit.values == pytest.approx(TRUE, rel=0.05)
    assert fit.load_torque == pytest.approx(ROLLING_N_M, abs=10.0)
    assert sum(hits(fit)) >= 7


@pytest.mark.nightly
def test_noise_of_the_torques_widens_the_intervals_from_another_start_too(fit: LogFit) -> None:
    """Their rate of covering the true values is in tests/nightly/measured."""
    noisy = fit_log(log_of(drive().noisy(0, 1.0)), START, drag)
    assert sum(hits(noisy)) >= 0.8 * len(noisy.std)
    assert all(noisy.std[name] > fit.std[name] for name in noisy.std)
    assert noisy.values['shaft_inertia'] == pytest.approx(TRUE['shaft_inertia'], rel=0.05)


def test_noise_with_a_memory_widens_the_intervals(fit: LogFit) -> None:
    """Correlated noise of the same size, over 0.08 s, has more weight at low frequencies."""
    from scipy.signal import lfilter

    random = np.random.default_rng(1)
    noise = lfilter([np.sqrt(1.0 - 0.9**2)], [1.0, -0.9], random.standard_normal((3, 601)))
    signals = dict(drive().signals)
    for name, size, each in zip(SPEEDS, NOISE_RAD_S, noise, strict=True):
        signals[name] = signals[name] + size * each
    slow = fit_log(log_of(signals), DrivelineParameters.from_values(TRUE), drag)
    for name in ('engine_inertia', 'total_ratio', 'vehicle_inertia'):
        assert slow.std[name] > 2.0 * fit.std[name]
    assert sum(hits(slow)) >= 6


def test_the_step_of_a_rounded_signal_is_found() -> None:
    signal = 80.0 + 60.0 * np.sin(np.arange(300) / 40.0)
    assert resolution(0.4 * np.round(signal / 0.4) - 100.0) == pytest.approx(0.4)
    assert resolution(signal) == resolution(np.full(300, 7.0)) == 0.0


def test_white_noise_is_measured_without_the_signal() -> None:
    torque = drive().clutch_torque
    assert white_noise(torque) < 1e-6
    noise = 2.0 * np.random.default_rng(0).standard_normal(len(torque))
    assert white_noise(torque + noise) == pytest.approx(2.0, rel=0.15)


def test_data_outside_the_fit_are_predicted_and_a_wrong_car_is_detected(fit: LogFit) -> None:
    other = replace(log_of(drive(2).noisy(7)), time_s=drive(2).time_s)
    stretches = stretches_of(other, drag)
    predictions = {each.signal: each for each in predict(fit, stretches)}
    assert max(each.nrmse or 1.0 for each in predictions.values()) < 0.02
    wrong = replace(fit, values={**fit.values, 'halfshaft_stiffness': 6000.0})
    missed = {each.signal: each.rms_rad_s for each in predict(wrong, stretches)}
    assert missed['shaft_speed'] > 2.0 * predictions['shaft_speed'].rms_rad_s


def test_what_the_log_does_not_show_is_named_and_kept() -> None:
    """The engine speed is constant, so neither inertia nor damping is identifiable."""
    signals = dict(drive().noisy(0))
    random = np.random.default_rng(5)
    count = len(drive().time_s)
    signals['engine_speed'] = 190.0 + 0.2 * random.standard_normal(count)
    signals['engine_torque'] = signals['clutch_torque'] + 0.02 * 190.0
    fit = fit_log(log_of(signals), START, drag)
    assert 'engine_inertia' in fit.undetermined
    assert fit.values['engine_inertia'] == START.engine_inertia
    assert fit.interval('engine_inertia') is None
    assert {'halfshaft_stiffness', 'vehicle_inertia'} <= set(fit.std)


def test_a_log_at_constant_speed_shows_nothing_beside_what_is_fixed() -> None:
    fixed = ('total_ratio', 'engine_damping', 'shaft_damping')
    with pytest.raises(
        DdctError, match='the log determines none of engine_inertia, shaft_inertia'
    ):
        fit_log(constant_log(), START, drag, fixed)


def test_a_fixed_parameter_keeps_its_value() -> None:
    """The torques have thrice the rows of the speeds, so that they are known between them."""
    signals, rows = drive().noisy(0), np.arange(len(drive().time_s))
    signals |= {name: np.where(rows % 3, np.nan, signals[name]) for name in SPEEDS}
    fit = fit_log(log_of(signals), START, drag)
    start = START.with_values(total_ratio=12.5)
    fixed = fit_log(log_of(signals), start, drag, ('total_ratio',))
    assert fixed.values['total_ratio'] == 12.5
    assert 'total_ratio' not in fixed.std
    assert fixed.std['vehicle_inertia'] <= 1.01 * fit.std['vehicle_inertia']


def test_gaps_uneven_steps_and_several_rates_cost_little() -> None:
    """Torques every 8 ms, speeds every 16 ms with jitter, none for 0.3 s, one torque lost."""
    full, signals = drive(), dict(drive().noisy(0))
    rows = np.arange(len(full.time_s))
    for name in ('engine_speed', 'shaft_speed', 'wheel_speed'):
        signals[name] = np.where(rows % 2 | ((rows > 300) & (rows < 338)), np.nan, signals[name])
    signals['engine_torque'] = np.where(rows == 100, np.nan, signals['engine_torque'])
    signals['wheel_speed'][rows % 22 == 4] = np.nan
    log = log_of(signals)
    stretches = stretches_of(log, drag)
    assert [len(each.time_s) > 100 for each in stretches] == [True, True]
    assert stretches[1].time_s[0] - stretches[0].time_s[-1] > 0.3
    fit = fit_log(log, START, drag)
    assert fit.values == pytest.approx(TRUE, rel=0.1)
    assert sum(hits(fit)) >= 6


@pytest.mark.parametrize(
    ('change', 'complaint'),
    [
        ({'wheel_speed': 30.0 / np.pi}, 'shaft_speed over wheel_speed is 1.31[0-9] as a rule'),
        ({'wheel_speed': np.nan}, '0 rows have all of engine_speed, shaft_speed, wheel_speed'),
    ],
)
def test_logs_that_cannot_be_are_refused(change: dict[str, float], complaint: str) -> None:
    signals = {name: each * change.get(name, 1.0) for name, each in drive().noisy(0).items()}
    with pytest.raises(DdctError, match=complaint):
        fit_log(log_of(signals), START, drag)


def test_a_log_of_holes_alone_is_refused() -> None:
    signals = dict(drive().noisy(0))
    rows = np.arange(len(drive().time_s))
    holes = np.where(rows % 30 < 12, np.nan, 0.0)
    signals['clutch_torque'] = signals['clutch_torque'] + holes
    with pytest.raises(DdctError, match='no 40 samples in a row without a gap'):
        fit_log(log_of(signals), START, drag)


def test_the_drive_of_the_other_car_has_its_stated_length() -> None:
    assert drive().time_s[-1] == pytest.approx(LASTS_S)


@pytest.mark.nightly
@pytest.mark.slow
def test_a_fit_to_an_exact_log_of_20_s_settles_within_few_evaluations(tmp_path: Path) -> None:
    """The noise of such a log is the rounding of the speeds, which grow with its length."""
    record(plan('pi', 'headless', duration_s=20.0), tmp_path / 'pi')
    log = read_log(tmp_path / 'pi', own_columns(TIME, *NEEDED), NEEDED)
    evaluations: list[int] = []
    fit = fit_log(log, START, drag, evaluated=lambda: evaluations.append(1))
    assert fit.values['engine_inertia'] == pytest.approx(START.engine_inertia, rel=1e-6)
    assert len(evaluations) < 1000
