# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The scenario that `identify` writes replays the log: its torque, speeds, duration and name."""

from pathlib import Path

import numpy as np
import pytest
from samples import sampled
from support.logs import drive_log, noisy_log, rows_late, written
from support.other_car import COLUMNS, drive, write_csv
from support.runs import plan, record

from ddct_bringup.identification.identify import main
from ddct_bringup.logs.log import SPEEDS, MeasuredLog
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.csv_text import signals_csv
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures('each_fit_once')]

OTHER_CAR = (
    'vehicle.mass_kg=1900',
    'driveline.engine_inertia=0.3',
    'initial.engine_speed_rad_s=185',
    'initial.shaft_speed_rad_s=150',
    'engine.torque_n_m=[20,220]',
)
ROOT = Path(__file__).resolve().parents[2]
TOLERANCE = 0.01
"""R.m.s. of the replay's error, over the standard deviation of the speed in the log."""


def replayed(log: MeasuredLog, folder: Path, control_start_s: float) -> Scenario:
    """Return the scenario of the car and drive that `identify` writes for a log."""
    columns = ['time_s', *(f'{name}_rad_s' for name in SPEEDS)]
    columns[2] = 'primary_shaft_speed_rad_s'
    columns += ['engine_torque_n_m', 'primary_shaft_effort_n_m']
    values = [log.time_s, *(log.signals[n] for n in (*SPEEDS, 'engine_torque', 'clutch_torque'))]
    rows = [','.join(f'{each:.9g}' for each in row) for row in zip(*values, strict=True)]
    file = folder / 'tip in.csv'
    file.write_text('\n'.join([','.join(columns), *rows]) + '\n')
    out = folder / 'mine'
    assert main(['--from', str(file), '--out', str(out), '--fix', 'engine_damping']) == 0
    changes = [f'control_start_s={control_start_s:g}', 'reference.slope_rad_s2=114.0']
    return written(out, 'tip_in', changes)


@pytest.mark.parametrize('rows', sampled([2, 0], every=2))
def test_a_drive_of_a_known_plant_comes_back_from_the_scenario_of_its_log(
    tmp_path: Path, rows: int
) -> None:
    """The base scenario is another car with other speeds; with 2 rows C_m and C_f are late."""
    true = drive_log(tmp_path, 'pi', OTHER_CAR)
    log = noisy_log(true, 0, 0.05)
    if rows:
        log = rows_late(log, ('engine_torque', 'clutch_torque'), rows)
    scenario = replayed(log, tmp_path, 0.6 - 0.01 * rows)
    assert scenario.name == 'tip_in_drive_tip_in_car'
    assert scenario.duration_s == pytest.approx(3.0 - 0.01 * rows)
    assert scenario.initial.engine_speed_rad_s == pytest.approx(185.0, abs=0.5)
    run = run_headless(RunSettings(KnownSettings(scenario)), 'pi')
    found = np.array(run.joint_speed)[:, :3]
    speeds = np.column_stack([true.signals[name] for name in SPEEDS])[rows:]
    speeds = speeds[: len(found)]
    loose = TOLERANCE if not rows else 5.0 * TOLERANCE
    error = np.sqrt(np.mean((found[: len(speeds)] - speeds) ** 2, axis=0))
    assert np.all(error < loose * speeds.std(axis=0))


def test_the_car_has_the_mass_of_the_log_whatever_mass_was_set(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / 'map.yaml').write_text(COLUMNS)
    write_csv(tmp_path / 'drive.csv', 3, drive(1))
    options = ['--from', str(tmp_path / 'drive.csv'), '--columns', str(tmp_path / 'map.yaml')]
    out = tmp_path / 'mine'
    assert main([*options, '--set', 'vehicle.mass_kg=290', '--out', str(out)]) == 0
    assert 'vehicle.mass_kg is 290 kg' in capsys.readouterr().err
    scenario = written(out)
    assert scenario.vehicle.mass_kg == pytest.approx(
        scenario.driveline.vehicle_inertia / scenario.vehicle.wheel_radius_m**2
    )
    assert scenario.driveline.vehicle_inertia == pytest.approx(190.0, rel=0.02)


def test_a_measured_load_becomes_a_slope_over_time(tmp_path: Path) -> None:
    """The road climbs from 0 to 4 % between 1 and 2 s; the bag has no C_load, the CSV has."""
    hill = ('slope.time_s=[0.0,1.0,2.0,3.0]', 'slope.slope_rad=[0.0,0.0,0.04,0.04]')
    recording = record(plan('pi', 'headless', duration_s=3.0, changes=hill), tmp_path / 'pi')
    (tmp_path / 'pi.csv').write_text(signals_csv(recording))
    (tmp_path / 'map.yaml').write_text(
        (ROOT / 'docs/use/own_car_columns.yaml').read_text().partition('run:')[0]
        + '  load_torque: {column: load_torque_n_m, unit: N m, between: held}\n'
    )
    options = ['--from', str(tmp_path / 'pi.csv'), '--columns', str(tmp_path / 'map.yaml')]
    out = tmp_path / 'mine'
    assert main([*options, '--fix', 'engine_damping', '--out', str(out)]) == 0
    slope = written(out, 'pi').slope
    times = np.array(slope.time_s)
    expected = np.interp(times, [1.0, 2.0], [0.0, 0.04])
    assert np.allclose(slope.slope_rad, expected, rtol=0.0, atol=1e-3)


def test_the_profile_is_the_torque_of_the_log_at_its_own_times(tmp_path: Path) -> None:
    """The log starts at 700 s and is linear between rows of 8 ms."""
    (tmp_path / 'map.yaml').write_text(COLUMNS)
    write_csv(tmp_path / 'drive.csv', 3, drive(1))
    options = ['--from', str(tmp_path / 'drive.csv'), '--columns', str(tmp_path / 'map.yaml')]
    out = tmp_path / 'mine'
    assert main([*options, '--out', str(out)]) == 0
    scenario, logged = written(out), drive(1)
    assert scenario.duration_s == 4.8
    assert scenario.initial.engine_speed_rad_s == pytest.approx(190.0, abs=0.3)
    # The shaft starts at 4000 rad/s^2, and its delay is known to 0.3 ms.
    assert scenario.initial.shaft_speed_rad_s == pytest.approx(150.0, abs=1.2)
    middles = np.arange(480) * 0.01 + 0.005
    expected = np.interp(middles, logged.time_s, logged.engine_torque)
    found = scenario.engine.over(np.arange(480) * 0.01)
    assert np.sqrt(np.mean((found - expected) ** 2)) < 0.3
