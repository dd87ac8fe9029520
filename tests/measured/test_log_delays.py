# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Delays of the signals of a log are found, with intervals that cover them."""

from pathlib import Path

import pytest
from refusals import refused
from samples import sampled
from support.log_coverage import BEFORE, coverage
from support.logs import (
    NONE_LATE,
    drag,
    noisy_log_of,
    require_delays_alone,
    speeds_late,
    within,
)
from support.other_car import SPEEDS, TRUE, late_log

from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.logs.columns import load_columns
from ddct_bringup.logs.log import MeasuredLog
from ddct_plant.base.errors import DdctError
from ddct_plant.models.parameters import DrivelineParameters

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ('late', 'rows', 'true'),
    [
        (('clutch_torque',), 1, NONE_LATE | {'clutch_torque': 0.01}),
        pytest.param(SPEEDS, 5, speeds_late(0.05), marks=pytest.mark.nightly),
    ],
    ids=['clutch torque 10 ms', 'speeds 50 ms'],
)
def test_signals_that_are_rows_late_move_delays_and_not_parameters(
    pi_log: MeasuredLog, late: tuple[str, ...], rows: int, true: dict[str, float]
) -> None:
    """More logs are in tests/nightly/measured."""
    require_delays_alone(pi_log, late, rows, true)


@pytest.mark.parametrize('kind', sampled(reversed(BEFORE), every=3))
def test_intervals_cover_the_true_values_in_a_sample_of_drives(
    pi_log: MeasuredLog, kind: str
) -> None:
    """Of 60 intervals 57 are expected, with a deviation of 2; 200 drives are in tests/nightly."""
    found = coverage(kind, range(5), pi_log)
    held, fitted = map(sum, zip(found.parameters, found.delays, strict=True))
    assert fitted == 60
    assert held >= 52


@pytest.mark.parametrize('corners_on_rows', sampled([True, False], every=2))
def test_fractional_delays_are_found(corners_on_rows: bool) -> None:
    true = {
        'shaft_speed': 0.0037,
        'wheel_speed': 0.0214,
        'engine_torque': -0.0062,
        'clutch_torque': 0.0491,
    }
    times, signals = late_log(1, true, corners_on_rows=corners_on_rows)
    fit = fit_log(noisy_log_of(times, signals, 3), DrivelineParameters(), drag)
    assert sum(within(fit, true)) >= 3
    assert fit.delays == pytest.approx({'engine_speed': 0.0, **true}, abs=1.5e-3)
    assert fit.values == pytest.approx(TRUE, rel=0.06)


def test_rows_that_are_means_over_their_step_are_half_a_step_late() -> None:
    """The speeds are sampled at the row's end, the torques are means over the 10 ms before."""
    times, signals = late_log(2, {}, mean_of=20)
    _, instants = late_log(2, {})
    signals |= {name: instants[name] for name in SPEEDS}
    fit = fit_log(noisy_log_of(times, signals, 4), DrivelineParameters(), drag)
    true = {'clutch_torque': 0.00475, 'engine_torque': 0.00475}
    assert all(within(fit, true))
    assert fit.values == pytest.approx(TRUE, rel=0.06)


def test_a_delay_of_all_signals_is_not_identifiable_and_changes_nothing() -> None:
    late = dict.fromkeys((*SPEEDS, *NONE_LATE), 0.0137)
    times, signals = late_log(3, late)
    fit = fit_log(noisy_log_of(times, signals, 5), DrivelineParameters(), drag)
    assert sum(within(fit, NONE_LATE)) >= 3
    assert fit.delays == pytest.approx({'engine_speed': 0.0, **NONE_LATE}, abs=1.5e-3)


def test_a_delay_that_is_known_is_not_fitted(tmp_path: Path) -> None:
    true = NONE_LATE | {'clutch_torque': 0.02}
    times, signals = late_log(1, true, corners_on_rows=True)
    log = noisy_log_of(times, signals, 6)
    given = fit_log(log, DrivelineParameters(), drag, (), {'clutch_torque': 0.02})
    found = fit_log(log, DrivelineParameters(), drag)
    assert given.interval('clutch_torque') is None
    assert given.delays['clutch_torque'] == 0.02
    assert given.std['shaft_inertia'] < found.std['shaft_inertia']
    assert given.values == pytest.approx(TRUE, rel=0.05)


def test_a_column_map_gives_delays(tmp_path: Path) -> None:
    file = tmp_path / 'map.yaml'
    text = 'columns:\n  time: {column: t, unit: s}\n  engine_torque: {column: m, unit: Nm%s}\n'
    file.write_text(text % ', delay_s: -0.03')
    assert load_columns(str(file)).known_delays == {'engine_torque': -0.03}
    for wrong in ('0.2', '.nan', 'true', '10 ms'):
        file.write_text(text % f', delay_s: {wrong}')
        with refused(DdctError, 'columns.engine_torque.delay_s', place='map.yaml'):
            load_columns(str(file))
