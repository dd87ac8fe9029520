# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`score` and `report` read logs of other tools; values without the needed columns are null."""

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.other_car import COLUMNS, LASTS_S, TRUE, drive, write_csv
from support.runs import plan, record

from ddct_bringup.bag.measured_run import read_measured_run
from ddct_bringup.bag.recording import Recording
from ddct_bringup.logs.columns import load_columns
from ddct_bringup.metrics.catalogue import METRICS, NEEDED_BY
from ddct_bringup.programs import report, score
from ddct_bringup.run.timing_and_failure import NOTE_FILE
from ddct_bringup.scores.csv_text import signals_csv
from ddct_bringup.scores.document import run_entry
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.files.json_records import to_json

pytestmark = pytest.mark.slow

OURS = """\
columns:
  time: {column: time_s, unit: s}
  engine_speed: {column: engine_speed_rad_s, unit: rad/s}
  shaft_speed: {column: primary_shaft_speed_rad_s, unit: rad/s}
  wheel_speed: {column: wheel_speed_rad_s, unit: rad/s}
  clutch_torque: {column: primary_shaft_effort_n_m, unit: N m}
  driveshaft_torque: {column: driveshaft_effort_n_m, unit: N m}
  vehicle_accel: {column: vehicle_accel_m_s2, unit: m/s^2}
  slip_reference: {column: slip_reference_rad_s, unit: rad/s}
  torque_request: {column: torque_request_n_m, unit: N m}
  engine_torque: {column: engine_torque_n_m, unit: N m}
  torque_demand: {column: torque_demand_n_m, unit: N m}
run: {controller: pi, scenario: bench, control_start_s: 0.6, score_window_s: [0.6, 1.7]}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    run = (
        '  vehicle_accel: {column: ax, unit: g}\nrun: {control_start_s: 0.5, total_ratio: 12.5}\n'
    )
    (tmp_path / 'map.yaml').write_text(COLUMNS + run)
    write_csv(tmp_path / 'drive.csv', 3, drive(1))
    return tmp_path


@pytest.fixture(scope='module')
def own_run(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    return record(plan('pi', 'headless', duration_s=3.0), tmp_path_factory.mktemp('own') / 'pi')


@pytest.fixture
def own_log(own_run: Recording, tmp_path: Path) -> Path:
    """Return a folder with that run as the log of another tool, and its column map."""
    (tmp_path / 'drive.csv').write_text(signals_csv(own_run))
    (tmp_path / 'map.yaml').write_text(OURS)
    return tmp_path


def scored(folder: Path, *options: str, columns: str = 'map.yaml') -> dict[str, Any]:
    out = folder / 'scores.json'
    given = [str(folder / 'drive.csv'), '--columns', str(folder / columns)]
    code = score.main([*given, '--json', str(out), *options])
    (run,) = json.loads(out.read_text())['runs']
    assert code == (0 if run['valid'] else 1)
    return run


def values_of(run: Mapping[str, Any]) -> dict[str, Any]:
    """Return the figures and metrics of an entry by key."""
    values = {**run['figures'], **run['metrics']}
    return {key: value for key, value in values.items() if key != 'least_is_bound'}


def test_our_own_signals_as_a_foreign_log_have_the_scores_of_the_bag(
    own_run: Recording, own_log: Path
) -> None:
    assert own_run.settings is not None
    ratio = own_run.settings.scenario.driveline.gear.total_ratio
    (own_log / 'map.yaml').write_text(OURS.replace('run: {', f'run: {{total_ratio: {ratio!r}, '))
    scores = score_recording(own_run, 'pi', packaged_limits()).scores
    found, wanted = scored(own_log), to_json(run_entry(scores))
    of_plant = {
        'friction_work_over_least': 'a log has no inertias of the car',
        'driving_acceleration_m_s2': 'the plant is not known',
    }
    ours, theirs = values_of(wanted), values_of(found)
    assert ours.keys() == theirs.keys()
    for name, value in ours.items():
        if name in of_plant:
            assert theirs[name] is None
            assert found['null_reasons'][name] == of_plant[name]
        elif not METRICS[name].from_timing:
            same = None if value is None else pytest.approx(value, rel=1e-9)
            assert theirs[name] == same, name
    assert (found['state'], found['why']) == (wanted['state'], wanted['why'])
    log = read_measured_run(own_log / 'drive.csv', load_columns(str(own_log / 'map.yaml')))
    np.testing.assert_allclose(
        log.trajectory.joint_speed[:, 3], own_run.trajectory.joint_speed[:, 3], atol=1e-9
    )
    assert (found['mode'], found['scenario'], found['controller']) == ('measured', 'bench', 'pi')


def test_what_the_columns_do_not_allow_is_null_with_its_reason(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = scored(folder)
    metrics, reasons = values_of(run), run['null_reasons']
    assert run['valid'] is True
    assert metrics['steps'] == round(100 * LASTS_S)
    exact = drive(1)
    window = exact.time_s >= 0.5
    assert metrics['acceleration_std_m_s2'] == pytest.approx(np.std(exact.accel[window]), rel=0.02)
    twist_speed = exact.speeds[:, 1] / TRUE['total_ratio'] - exact.speeds[:, 2]
    true_std = 30.0 / np.pi * np.hypot(np.std(twist_speed[window]), np.hypot(0.2 / 12.5, 0.02))
    assert metrics['torsion_speed_std_rpm'] == pytest.approx(true_std, rel=0.2)
    power = np.abs((exact.speeds[:, 0] - exact.speeds[:, 1]) * exact.clutch_torque)
    work = np.trapezoid(power[window], exact.time_s[window])
    assert metrics['friction_work_j'] == pytest.approx(work, rel=0.01)
    assert 'friction_work_j' not in reasons
    assert metrics['torque_late_s'] is None
    assert reasons['torque_late_s'] == 'the log has no torque_demand'
    assert reasons['releases'] == 'a log has no phases of the plates'
    assert reasons['peak_jerk_over_least'] == 'a log has no scenario, and no floor'
    assert 'the log has no torque_demand' in ' '.join(capsys.readouterr().out.split())


def test_a_log_of_two_speeds_alone_still_has_its_engagement(folder: Path) -> None:
    lines = COLUMNS.splitlines(keepends=True)
    (folder / 'map.yaml').write_text(''.join(lines[:4]))
    run = scored(folder)
    assert run['metrics']['slip_final_rpm'] is not None
    assert set(run['null_reasons']) == {
        name for name, value in values_of(run).items() if value is None
    }
    assert run['null_reasons']['peak_jerk_m_s3'] == 'the log has no vehicle_accel'
    assert 'run.total_ratio' in run['null_reasons']['torsion_speed_std_rpm']


def test_files_next_to_a_log_do_not_belong_to_it(folder: Path) -> None:
    """A run of ours that failed may have been in the same folder."""
    (folder / NOTE_FILE).write_text('{}')
    assert scored(folder)['valid'] is True


def test_every_name_of_what_needs_a_quantity_is_a_metric() -> None:
    named = {name for names in NEEDED_BY.values() for name in names}
    assert named <= set(METRICS)


@pytest.mark.parametrize(
    'column', ['vehicle_accel', 'clutch_torque', 'engine_torque', 'torque_demand']
)
def test_each_value_that_is_lost_with_a_column_has_a_reason(own_log: Path, column: str) -> None:
    before = values_of(scored(own_log))
    fewer = re.sub(f'  {column}: .*\n', '', OURS)
    (own_log / 'fewer.yaml').write_text(fewer)
    without = scored(own_log, columns='fewer.yaml')
    after = values_of(without)
    lost = [name for name in before if before[name] is not None and after[name] is None]
    assert lost
    assert all(without['null_reasons'][name] == f'the log has no {column}' for name in lost)


def test_the_report_shows_a_log_and_the_reason_of_each_empty_cell(folder: Path) -> None:
    page = folder / 'report.html'
    columns = ['--columns', str(folder / 'map.yaml')]
    assert report.main([str(folder / 'drive.csv'), *columns, '--out', str(page)]) == 0
    text = page.read_text()
    assert 'drive.csv' in text
    assert 'the log has no torque_demand' in text


def test_a_fast_log_is_averaged_and_a_slow_acceleration_refused(folder: Path) -> None:
    time_s = np.arange(0.0, 2.0, 0.001)
    noise = np.random.default_rng(0).standard_normal(len(time_s))
    rows = [
        f'{t:.3f},{100.0 - 20.0 * t + 3.0 * e:.6f},60.0,{t if k % 50 == 0 else ""}\n'
        for k, (t, e) in enumerate(zip(time_s, noise, strict=True))
    ]
    (folder / 'drive.csv').write_text('t,m,p,a\n' + ''.join(rows))
    quantities = {'engine_speed': 'm', 'shaft_speed': 'p'}
    lines = ['columns:', '  time: {column: t, unit: s}']
    lines += [f'  {name}: {{column: {c}, unit: rad/s}}' for name, c in quantities.items()]
    lines += ['  vehicle_accel: {column: a, unit: m/s^2}']
    (folder / 'map.yaml').write_text('\n'.join(lines) + '\n')
    run = scored(folder, '--signals-csv', str(folder / 'signals'))
    assert run['valid'], run['reason']
    assert run['null_reasons']['peak_jerk_m_s3'].startswith(
        'the samples of vehicle_accel are 0.05 s'
    )
    (file,) = (folder / 'signals').iterdir()
    table = np.genfromtxt(file, delimiter=',', names=True)
    left = table['slip_speed_rad_s'] - (40.0 - 20.0 * table['time_s'])
    assert np.std(left[1:-1]) == pytest.approx(3.0 / np.sqrt(10.0), rel=0.2)


def speeds_of_log(folder: Path, time_s: np.ndarray, engine_speed: np.ndarray) -> np.ndarray:
    """Return w_m in rad/s on the grid, of a log with samples of it at these times."""
    rows = [f'{t:.4f},{s:.9f},60.0\n' for t, s in zip(time_s, engine_speed, strict=True)]
    (folder / 'fast.csv').write_text('t,m,p\n' + ''.join(rows))
    (folder / 'map.yaml').write_text(
        'columns:\n  time: {column: t, unit: s}\n  engine_speed: {column: m, unit: rad/s}\n'
        '  shaft_speed: {column: p, unit: rad/s}\nrun: {start_s: 0.0}\n'
    )
    run = read_measured_run(folder / 'fast.csv', load_columns(str(folder / 'map.yaml')))
    return run.trajectory.joint_speed[:, 0]


def test_a_fast_log_is_averaged_over_the_10_ms_around_each_instant(folder: Path) -> None:
    time_s = 0.0005 + 0.001 * np.arange(-5, 2000)  # none is on an edge of what is averaged
    speed = 100.0 + np.random.default_rng(0).standard_normal(len(time_s))
    wanted = speed[:2000].reshape(-1, 10).mean(axis=1)  # from 5 ms before to 5 ms after
    found = speeds_of_log(folder, time_s, speed)
    np.testing.assert_allclose(found[:200], wanted[:200], atol=1e-8)


@pytest.mark.parametrize('rows', [400, 2000])
def test_a_log_with_5_ms_from_sample_to_sample_is_taken_as_it_is(folder: Path, rows: int) -> None:
    """Whatever the rounding of its decimal times makes of their median."""
    time_s = 0.005 * np.arange(rows)
    speed = 100.0 + np.random.default_rng(0).standard_normal(len(time_s))
    found = speeds_of_log(folder, time_s, speed)
    np.testing.assert_allclose(found[:100], speed[:200:2], atol=1e-8)


@pytest.mark.parametrize(
    ('old', 'new', 'complaint'),
    [
        ('total_ratio: 12.5', 'ratio: 12.5', 'unknown key run.ratio: did you mean'),
        ('0.5', '0.501', 'run.control_start_s is 0.501 s: give a multiple of 0.01 s'),
        ('0.5', '0.5, start_s: 1.0', 'run.start_s, 1 s, does not begin'),
        ('0.5', '0.5, score_window_s: [1.0]', 'run.score_window_s: give two times'),
        ('nEin', 'nAus', "no column 'nAus'"),
    ],
)
def test_a_wrong_map_makes_an_invalid_entry_with_its_reason(
    folder: Path, old: str, new: str, complaint: str
) -> None:
    text = (folder / 'map.yaml').read_text()
    (folder / 'map.yaml').write_text(text.replace(old, new))
    run = scored(folder)
    assert run['valid'] is False
    assert complaint in run['reason']


def test_a_hole_in_the_log_is_reported_and_a_log_needs_its_map(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert score.main([str(folder / 'drive.csv')]) == 1
    assert 'the log needs a column map: give --columns FILE' in capsys.readouterr().err
    lines = (folder / 'drive.csv').read_text().splitlines(keepends=True)
    (folder / 'drive.csv').write_text(''.join([*lines[:200], *lines[250:]]))
    run = scored(folder)
    assert 'has no sample from 701.576 to 701.984 s, more than 0.1 s' in run['reason']
