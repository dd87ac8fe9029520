# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`identify --from LOG`: a log of another tool, or a bag, becomes a scenario that runs."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.logs import identify
from support.other_car import COLUMNS, TRUE, drive, write_csv
from support.runs import expected, plan, record

from ddct_bringup.identification.from_log import command
from ddct_bringup.identification.identify import main
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.csv_text import signals_csv
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow


def test_a_foreign_log_gives_tables_json_and_a_scenario_that_runs(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_csv(folder / 'other.csv', 4, drive(2))
    out, report = folder / 'mycar.yaml', folder / 'report.json'
    check = ['--check', str(folder / 'other.csv')]
    assert identify(folder, *check, '--out', str(out), '--json', str(report)) == 0
    printed = capsys.readouterr().out
    assert 'intervals of 95 %' in ' '.join(printed.split())
    content = json.loads(report.read_text())
    rows = {row['name']: row for row in content['parameters']}
    assert {row['state'] for row in rows.values()} == {'fitted'}
    held = [rows[n]['lowest'] <= value <= rows[n]['highest'] for n, value in TRUE.items()]
    assert sum(held) >= 6
    signals = {each['signal']: each for each in content['held_out']['signals']}
    assert all(each['nrmse'] < 0.02 for each in signals.values())
    assert signals['shaft_speed']['white'] is True
    scenario = load_scenario(str(out))
    assert scenario.name == 'drive'
    assert 'drive.csv' in scenario.description
    assert [line.split()[0] for line in scenario.adjusted] == [
        'vehicle.mass_kg',
        'gear',
        'load.slope_rad',
    ]
    assert scenario.driveline.vehicle_inertia == rows['vehicle_inertia']['value']
    assert run_headless(RunSettings(KnownSettings(scenario)), 'pi').steps == scenario.steps
    car = load_scenario('thesis', ['gear=1'], car=str(folder / 'mycar_car.yaml'))
    assert (car.driveline.shaft_inertia, car.vehicle) == (
        scenario.driveline.shaft_inertia,
        scenario.vehicle,
    )
    replay = load_scenario(car='c635_thesis', drive=str(folder / 'mycar_drive.yaml'))
    assert (replay.engine, replay.duration_s) == (scenario.engine, scenario.duration_s)


def test_the_scenario_of_a_noisy_bag_reproduces_another_run_of_the_same_car(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The car is heavier than that of the base scenario; ls8 was not among the fitted runs."""
    heavy = ('vehicle.mass_kg=1900', 'driveline.engine_inertia=0.3')
    recording = record(plan('pi', 'headless', duration_s=3.0, changes=heavy), tmp_path / 'pi')
    random = np.random.default_rng(0)
    lines = signals_csv(recording).splitlines()
    names = lines[0].split(',')
    speeds = [n for n in names if n.endswith('speed_rad_s') and n[0] in 'epw']
    for number, line in enumerate(lines[1:], 1):
        cells = dict(zip(names, line.split(','), strict=True))
        for name in speeds:
            cells[name] = repr(float(cells[name]) + 0.05 * random.standard_normal())
        lines[number] = ','.join(cells.values())
    (tmp_path / 'noisy.csv').write_text('\n'.join(lines) + '\n')
    out = tmp_path / 'mine.yaml'
    fixed = ['--fix', 'engine_damping']
    assert main(['--from', str(tmp_path / 'noisy.csv'), '--out', str(out), *fixed]) == 0
    truth = expected(plan('ls8', 'headless', duration_s=3.0, changes=heavy))
    found = run_headless(
        RunSettings(KnownSettings(load_scenario(str(out), ['duration_s=3.0']))), 'ls8'
    )
    thesis = expected(plan('ls8', 'headless', duration_s=3.0))
    spread = np.std(truth.slip_speed)
    assert np.sqrt(np.mean((found.slip_speed - truth.slip_speed) ** 2)) < 0.02 * spread
    assert np.sqrt(np.mean((thesis.slip_speed - truth.slip_speed) ** 2)) > 0.05 * spread
    assert 'Prediction of' in capsys.readouterr().out


@pytest.mark.parametrize('scenario', ['thesis', 'thesis_sticking'])
def test_a_bag_needs_no_columns_and_gives_back_its_driveline(
    tmp_path: Path, scenario: str, capsys: pytest.CaptureFixture[str]
) -> None:
    run = plan('pi', 'headless', duration_s=1.5, scenario=scenario)
    record(run, tmp_path / 'pi')
    assert main(['--from', str(tmp_path / 'pi'), '--json', '-']) == 0
    content = json.loads(capsys.readouterr().out)
    true = run.settings.scenario.driveline.values()
    for row in content['parameters']:
        scale = max(true[row['name']], 0.01)
        tight = 1e-3 if scenario == 'thesis' else 0.1
        assert row['used'] == pytest.approx(true[row['name']], abs=tight * scale), row['name']


@pytest.mark.parametrize(
    ('old', 'new', 'complaint'),
    [
        ('unit: rpm}\n  shaft', 'unit: rad/s}\n  shaft', 'is it in another unit than rad/s?'),
        ('nMot', 'nMotor', "no column 'nMotor': did you mean nMot?"),
        ('unit: Nm', 'unit: rpm', "columns.clutch_torque: unit 'rpm': choose from N m, Nm, kN m"),
        (', unit: Nm', '', 'columns.clutch_torque: give {column: NAME, unit: UNIT}'),
        ('clutch_torque', 'clutch_torqe', 'unknown columns.clutch_torqe: did you mean'),
        (
            '  clutch_torque: {column: MdKup, unit: Nm}\n',
            '',
            'map has no clutch_torque',
        ),
        ('unit: Nm', 'unit: Nm, between: spline', "between is 'spline': choose from linear, held"),
        ('time:', 'vehicle_speed:', "unit 'ms': choose from m/s, km/h"),
        ('columns:', 'colums:', 'give columns by quantity'),
        (
            'unit: Nm',
            'unit: Nm, betwen: held',
            'columns.clutch_torque.betwen: did you mean',
        ),
        ('unit: Nm', 'unit: Nm, x: y', 'columns.clutch_torque.x: known: column, unit, between'),
        ('columns:', 'x: 1\ncolumns:', 'unknown key x: known: columns, run'),
    ],
)
def test_a_wrong_column_map_is_refused_in_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, complaint: str
) -> None:
    (folder / 'map.yaml').write_text(COLUMNS.replace(old, new))
    assert identify(folder) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert complaint in line


@pytest.mark.parametrize(
    ('change', 'complaint'),
    [
        (lambda lines: [*lines[:9], lines[4], *lines[9:]], 'line 10, column Zeit: the time goes'),
        (lambda lines: [*lines[:9], lines[9][12:], *lines[10:]], 'line 10'),
        (lambda lines: [*lines[:9], lines[9].replace(';', ';x', 1)], "line 10, column nMot: 'x"),
        (lambda lines: lines[:30], ' rows have all of engine_speed'),
        (lambda lines: lines[:2], 'no row of numbers below the header'),
        (lambda lines: [*lines[:9], ';' + lines[9].partition(';')[2]], 'the time is empty'),
    ],
)
def test_a_bad_log_is_refused_in_one_line_with_its_place(
    folder: Path, capsys: pytest.CaptureFixture[str], change: object, complaint: str
) -> None:
    file = folder / 'drive.csv'
    assert callable(change)
    file.write_text('\n'.join(change(file.read_text().splitlines())) + '\n')
    assert identify(folder, '--hold-out', '0.1') == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert complaint in line
    assert str(file) in line


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (
            ['--fix', 'total_ratio'],
            '--check, --fix, --set, --force, --out and --overwrite need a log',
        ),
        (['--from', 'a.csv', '--as-printed'], '--as-printed is about the thesis'),
        (['--from', 'a.csv', '--hold-out', '1.5'], '--hold-out is 1.5: give a share'),
        (['--from', 'none.csv'], 'none.csv: cannot be read'),
        (['--from', 'none.mcap'], 'none.mcap: no such file or folder'),
        (['--from', 'a.csv', '--columns', 'none.yaml'], '--columns none.yaml: cannot be read'),
    ],
)
def test_options_that_make_no_sense_are_refused(
    capsys: pytest.CaptureFixture[str], options: list[str], complaint: str
) -> None:
    assert main(options) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert complaint in line


@pytest.mark.parametrize('option', ['--from', '--check'])
@pytest.mark.parametrize(('unit', 'period'), [('s', '8 s'), ('us', '8e-06 s')])
def test_a_wrong_unit_of_the_time_is_named_before_the_fit(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    option: str,
    unit: str,
    period: str,
) -> None:
    """The rows are 8 ms apart: in --from the map has a wrong unit, in --check the file."""
    monkeypatch.setattr(command, 'fit_log', _no_fit)
    wrong = folder / 'drive.csv'
    if option == '--check':
        wrong = folder / 'other.csv'
        lines = (folder / 'drive.csv').read_text().splitlines()
        rows = [line.split(';') for line in lines[2:]]
        factor = {'s': 1e3, 'us': 1e-3}[unit]
        times = [f'{factor * float(row[0].replace(",", ".")):.9f}' for row in rows]
        moved = [';'.join([time, *row[1:]]) for time, row in zip(times, rows, strict=True)]
        wrong.write_text('\n'.join([*lines[:2], *moved]) + '\n')
    else:
        (folder / 'map.yaml').write_text(COLUMNS.replace('unit: ms', f'unit: {unit}'))
    assert identify(folder, *(['--check', str(wrong)] if option == '--check' else [])) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert f'{wrong}: engine_speed has a sampling period of {period}' in line
    assert 'check the unit of columns.time, with which the period may be 0.008 s' in line


def _no_fit(*_: object) -> None:
    raise AssertionError('the fit began')


def test_an_existing_file_is_refused_at_out_before_the_fit_and_stays(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, 'fit_log', _no_fit)
    for content, options, complaint in (
        ('name: mine', [], 'exists already: choose another --out or add --overwrite'),
        ('a,b', ['--overwrite'], 'is no scenario, and --overwrite replaces only that'),
    ):
        (folder / 'mine.yaml').write_text(content)
        assert identify(folder, '--out', str(folder / 'mine.yaml'), *options) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert f'{folder / "mine.yaml"} {complaint}' in line
        assert (folder / 'mine.yaml').read_text() == content


def test_an_earlier_scenario_is_replaced_with_overwrite(folder: Path) -> None:
    out = folder / 'mine.yaml'
    out.write_text(scenario_to_yaml(load_scenario('launch')))
    assert identify(folder, '--out', str(out), '--overwrite') == 0
    assert load_scenario(str(out)).name == 'drive'
