# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`identify --from LOG`: a log of another tool, or a bag, becomes a scenario that runs."""

import json
from pathlib import Path

import numpy as np
import pytest
from by_schema import require_schema
from support.logs import identify, written
from support.other_car import COLUMNS, TRUE, drive, write_csv
from support.runs import expected, plan, record

from ddct_bringup.identification.from_log import command
from ddct_bringup.identification.identify import main
from ddct_bringup.programs import compare
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.csv_text import signals_csv
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures('each_fit_once')]

CONTROLLED = ['duration_s=3.0', 'control_start_s=0.6', 'reference.slope_rad_s2=114.0']
"""What a drive of the thesis's scenario has of it beside the log."""


def test_a_foreign_log_gives_tables_json_and_a_scenario_that_runs(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_csv(folder / 'other.csv', 4, drive(2))
    out, report = folder / 'mycar', folder / 'report.json'
    check = ['--check', str(folder / 'other.csv')]
    assert identify(folder, *check, '--out', str(out), '--json', str(report)) == 0
    printed = capsys.readouterr().out
    assert 'intervals of 95 %' in ' '.join(printed.split())
    content = json.loads(report.read_text())
    require_schema('identify_log', content)
    rows = {row['name']: row for row in content['parameters']}
    assert {row['state'] for row in rows.values()} == {'fitted'}
    held = [rows[n]['lowest'] <= value <= rows[n]['highest'] for n, value in TRUE.items()]
    assert sum(held) >= 6
    signals = {each['signal']: each for each in content['held_out']['signals']}
    assert all(each['nrmse'] < 0.02 for each in signals.values())
    scenario = written(out)
    assert scenario.name == 'drive_drive_drive_car'
    car, replay = ((out / f'drive_{noun}.yaml').read_text() for noun in ('car', 'drive'))
    assert 'base: c635_thesis' in car
    assert all('from drive.csv (SHA-256' in each for each in (car, replay))
    assert scenario.driveline.vehicle_inertia == pytest.approx(rows['vehicle_inertia']['value'])
    assert run_headless(RunSettings(KnownSettings(scenario)), 'pi').steps == scenario.steps
    in_first = load_scenario(car=str(out / 'drive_car.yaml'), drive='thesis', overrides=['gear=1'])
    assert (in_first.driveline, in_first.vehicle) == (scenario.driveline, scenario.vehicle)
    other = load_scenario(
        car='c635_thesis', drive=str(out / 'drive_drive.yaml'), overrides=['gear=1']
    )
    assert (other.engine, other.duration_s) == (scenario.engine, scenario.duration_s)


@pytest.mark.usefixtures('no_page')
def test_compare_runs_the_car_and_drive_at_once(folder: Path) -> None:
    assert identify(folder, '--out', str(folder / 'mine')) == 0
    files = [f'--{noun}={folder / "mine" / f"drive_{noun}.yaml"}' for noun in ('car', 'drive')]
    out = folder / 'compared'
    options = ['--floors', 'none', '--out', str(out)]
    assert compare.main(['--controllers', 'pi,ls8', '--headless', *files, *options]) == 0
    runs = json.loads((out / 'scores.json').read_text())['runs']
    assert [run['valid'] for run in runs] == [True, True]
    assert {run['scenario'] for run in runs} == {'drive_drive_drive_car'}


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
    out = tmp_path / 'mine'
    fixed = ['--fix', 'engine_damping']
    assert main(['--from', str(tmp_path / 'noisy.csv'), '--out', str(out), *fixed]) == 0
    truth = expected(plan('ls8', 'headless', duration_s=3.0, changes=heavy))
    found = run_headless(RunSettings(KnownSettings(written(out, 'noisy', CONTROLLED))), 'ls8')
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
        (['--from', 'none.csv', '--guess', '-'], 'none.csv: no such file or folder'),
        (['--from', 'tests', '--guess', '-'], 'tests: a bag needs no column map'),
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
    (folder / 'mine').mkdir()
    car = folder / 'mine' / 'drive_car.yaml'
    for content, options, complaint in (
        ('base: c635', [], 'exists already: choose another --out or add --overwrite'),
        ('a,b', ['--overwrite'], 'is no car, and --overwrite replaces only that'),
    ):
        car.write_text(content)
        assert identify(folder, '--out', str(folder / 'mine'), *options) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert f'{car} {complaint}' in line
        assert car.read_text() == content
    assert [*car.parent.iterdir()] == [car]


def test_out_is_a_folder(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert identify(folder, '--out', str(folder / 'map.yaml')) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert 'is a file: name a folder' in line


def test_an_earlier_car_and_drive_are_replaced_with_overwrite(folder: Path) -> None:
    out = folder / 'mine'
    for _ in range(2):
        assert identify(folder, '--out', str(out), '--overwrite') == 0
        assert written(out).driveline.engine_inertia == pytest.approx(0.18, rel=0.01)
        (out / 'drive_car.yaml').write_text('base: c635\n')


def test_a_log_with_uneven_times_is_refused_in_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every third row is lost, so that steps of 8 and 16 ms follow one another."""
    monkeypatch.setattr(command, 'fit_log', _no_fit)
    file = folder / 'drive.csv'
    lines = file.read_text().splitlines()
    kept = [line for number, line in enumerate(lines[2:]) if number % 3]
    file.write_text('\n'.join([*lines[:2], *kept]) + '\n')
    assert identify(folder) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert f'{file}: engine_speed is sampled unevenly' in line
    assert 'below 0.008 s and a tenth above 0.016 s' in line


@pytest.mark.parametrize(
    ('run', 'times'),
    [
        ('start_s: 701.0, control_start_s: 0.5', (1.5, (1.5, 4.8))),
        ('start_s: 700.0, control_start_s: 0.5, score_window_s: [0.6, 2.0]', (0.5, (0.6, 2.0))),
    ],
)
def test_control_start_and_window_of_the_drive_are_those_of_the_column_map(
    folder: Path, run: str, times: tuple[float, tuple[float, float]]
) -> None:
    (folder / 'map.yaml').write_text(f'{COLUMNS}run: {{{run}}}\n')
    assert identify(folder, '--out', str(folder / 'mine')) == 0
    found = written(folder / 'mine')
    assert (found.control_start_s, found.score_window_s) == times


@pytest.mark.nightly
def test_control_start_of_the_drive_may_be_set(folder: Path) -> None:
    assert identify(folder, '--out', str(folder / 'mine'), '--set', 'control_start_s=0.7') == 0
    found = written(folder / 'mine')
    assert (found.control_start_s, found.score_window_s) == (0.7, (0.7, 4.8))


def test_a_window_outside_of_the_log_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = 'run: {start_s: 704.0, control_start_s: 2.0}\n'
    (folder / 'map.yaml').write_text(COLUMNS + run)
    assert identify(folder, '--out', str(folder / 'mine')) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert 'control start at 6 s' in line
    assert not (folder / 'mine').exists()
