# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `score`: its output, files and exit codes."""

import csv
import io
import json
import math
import os
import subprocess
import sys
from importlib.resources import files

import numpy as np
import pytest
from waiting import WITHIN_S

from ddct_bringup.bag.reader import mcap_of
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import FIGURES
from ddct_bringup.programs.score import main
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.verdict.limits import load_limits

ENTRY_KEYS = [
    'bag',
    'controller',
    'architecture',
    'scenario',
    'wear_gain',
    'mode',
    'seed',
    'valid',
    'reason',
    'state',
    'why',
    'figures',
    'metrics',
    'limits',
    'null_reasons',
    'fallbacks',
    'safe_state',
    'scenario_changes',
    'gain_changes',
]


JOINTS = ('engine', 'primary_shaft', 'wheel', 'driveshaft')


def csv_signals(run):
    """Return the values of each column of a CSV file: of a period or a preview the first."""
    joints = {
        f'{joint}_{name}': signal[:, index]
        for index, joint in enumerate(JOINTS)
        for name, signal in (
            ('position_rad', run.joint_position),
            ('speed_rad_s', run.joint_speed),
            ('effort_n_m', run.joint_effort),
        )
    }
    return {
        'time_s': np.arange(run.steps + 1) / 100.0,
        **joints,
        'slip_speed_rad_s': run.slip_speed,
        'slip_reference_rad_s': run.slip_reference[:, 0],
        'slip_reference_rate_rad_s2': run.slip_reference_rate[:, 0],
        'vehicle_speed_m_s': run.vehicle_speed,
        'vehicle_accel_m_s2': run.vehicle_accel,
        'torque_demand_n_m': run.torque_demand,
        'engine_torque_n_m': run.engine_torque,
        'load_torque_n_m': run.load_torque,
        'torque_request_n_m': run.torque_request,
        'open_loop_torque_n_m': run.open_loop_torque,
        'closed_loop_torque_n_m': run.closed_loop_torque,
        'closing_torque_n_m': run.closing_torque,
        'actuator_torque_n_m': run.actuator_torque[:, 0],
        'clutch_torque_n_m': run.clutch_torque[:, 0],
    }


def runs_in(text):
    def refuse(constant):
        raise AssertionError(f'{constant} is no JSON')

    document = json.loads(text, parse_constant=refuse)
    assert list(document) == ['schema_version', 'limits', 'runs']
    assert document['schema_version'] == 4
    return document['runs']


def together(trajectory):
    """Return the same run with plates that never part."""
    return Trajectory({**trajectory.signals, 'slip_speed': np.zeros(trajectory.steps + 1)})


def limits_of(run):
    """Return the limits of an entry by metric."""
    return {each['name']: each['limit'] for each in run['limits']}


def test_a_valid_bag_gives_0_and_a_table(bags, trajectory, capsys):
    assert main([str(bags.write(trajectory))]) == 0
    output = capsys.readouterr().out
    assert 't_a' in output
    assert 'pi' in output
    assert '\x1b' not in output


def test_json_has_every_key_in_order(bags, trajectory, capsys):
    bag = bags.write(trajectory, wear_gain=0.7, seed=3)
    assert main([str(bag), '--json', '-']) == 0
    captured = capsys.readouterr()
    (run,) = runs_in(captured.out)
    assert list(run) == ENTRY_KEYS
    assert (run['wear_gain'], run['seed'], run['valid'], run['reason']) == (0.7, 3, True, '')
    assert run['bag'] == str(bag)
    assert run['metrics']['steps'] == trajectory.steps
    assert run['metrics']['resends'] is None
    assert 't_a' in captured.err


def test_a_folder_is_searched_and_bags_are_named_from_it(bags, trajectory, tmp_path):
    bags.write(trajectory, 'pi', folder='demo/pi')
    bags.write(trajectory, 'ls8', folder='demo/more/ls8')
    scores = tmp_path / 'scores.json'
    assert main([str(tmp_path / 'demo'), '--json', str(scores)]) == 0
    assert [run['bag'] for run in runs_in(scores.read_text())] == ['more/ls8', 'pi']


def test_timing_beside_the_bag_is_scored(bags, trajectory, capsys):
    bag = bags.write(trajectory)
    RunTiming(update_times_us=[10.0, 20.0, 30.0], missed_steps=1, resends=2).write(bag)
    assert main([str(bag), '--json', '-']) == 0
    metrics = runs_in(capsys.readouterr().out)[0]['metrics']
    assert metrics['update_time_median_us'] == 20.0
    assert (metrics['missed_steps'], metrics['resends']) == (1, 2)


def test_an_entry_has_its_state_figures_and_the_limits_of_its_scenario(bags, trajectory, capsys):
    bag = bags.write(together(trajectory), scenario='launch_gentle')
    assert main([str(bag), '--json', '-']) == 0
    (run,) = runs_in(capsys.readouterr().out)
    assert (run['state'], run['why']) == ('engaged', '')
    of_every_run = [each.key for each in FIGURES if not each.of_shift]
    assert list(run['figures']) == [*of_every_run, 'least_is_bound']
    assert not run['figures'].keys() & run['metrics'].keys()
    keys = ['name', 'value', 'limit', 'unit', 'source', 'convention']
    assert all(list(each) == keys for each in run['limits'])
    values = {**run['figures'], **run['metrics']}
    assert {each['name']: each['value'] for each in run['limits']} == {
        name: values[name] for name in limits_of(run)
    }
    assert {'mean_acceleration_m_s2', 'peak_temperature_degc', 'releases'} <= {*limits_of(run)}


def test_the_program_states_why_a_run_did_not_engage(bags, trajectory, capsys, monkeypatch):
    monkeypatch.chdir(bags.write(trajectory).parent)
    assert main(['pi', '--json', '-']) == 0
    printed = capsys.readouterr()
    (run,) = runs_in(printed.out)
    assert run['state'] == 'not_engaged'
    assert run['why'].startswith('the slip, ')
    assert f'pi: not_engaged: {run["why"]}' in ' '.join(printed.err.split())


def test_another_limits_file_judges_otherwise(bags, trajectory, tmp_path, capsys):
    bag = str(bags.write(together(trajectory)))
    mine = tmp_path / 'mine.yaml'
    text = (files('ddct_bringup.verdict') / 'limits.yaml').read_text(encoding='utf-8')
    mine.write_text(text[: text.index('traction:')] + 'limits: []\n', encoding='utf-8')
    assert main([bag, '--limits', str(mine), '--json', '-']) == 0
    printed = capsys.readouterr().out
    assert runs_in(printed)[0]['limits'] == []
    assert json.loads(printed)['limits'] == load_limits(mine).origin
    assert json.loads(printed)['limits']['name'] == 'mine.yaml'


def test_a_bad_limits_file_is_a_mistake(bags, trajectory, tmp_path, capsys):
    mine = tmp_path / 'mine.yaml'
    mine.write_text('rules: {}\nlimit: []\n', encoding='utf-8')
    assert main([str(bags.write(trajectory)), '--limits', str(mine)]) == 1
    captured = capsys.readouterr()
    assert captured.err == (
        f'ddct score: limits {mine}: line 2: unknown key limit: did you mean limits?\n'
    )
    assert captured.out == ''


def test_a_run_that_ended_early_is_not_valid(bags, trajectory, capsys):
    bag = bags.write(trajectory, duration_s=2.0, score_window_s=(0.1, 2.0))
    assert main([str(bag), '--json', '-']) == 1
    captured = capsys.readouterr()
    (run,) = runs_in(captured.out)
    assert not run['valid']
    assert run['reason'] == 'ended early: 60 of 200 steps'
    assert run['state'] == 'invalid'
    assert run['metrics']['torsion_speed_std_rpm'] is None
    assert 'ended early: 60 of 200 steps' in ' '.join(captured.err.split())


@pytest.mark.parametrize(
    ('value', 'named'), [(math.nan, 'non-finite value'), (1e308, 'value beyond +-1e+150')]
)
def test_a_value_that_no_signal_has_is_not_valid_and_named(bags, trajectory, capsys, value, named):
    spoiled = trajectory.joint_speed.copy()
    spoiled[30, 3] = value
    bag = bags.write(Trajectory({**trajectory.signals, 'joint_speed': spoiled}))
    assert main([str(bag), '--json', '-']) == 1
    (run,) = runs_in(capsys.readouterr().out)
    assert run['reason'] == f'{named} in joint_speed at 0.3 s'
    assert run['metrics']['torsion_speed_std_rpm'] is None
    assert run['metrics']['acceleration_std_m_s2'] > 0.0


def test_a_cut_bag_is_reported_and_the_others_are_scored(bags, trajectory, capsys):
    bags.write(trajectory, 'ls8', folder='demo/ls8')
    cut = mcap_of(bags.write(trajectory, 'pi', folder='demo/pi'))
    cut.write_bytes(cut.read_bytes()[:-10])
    assert main([str(bags.folder / 'demo'), '--json', '-']) == 1
    captured = capsys.readouterr()
    whole, broken = runs_in(captured.out)
    assert whole['valid']
    assert (broken['controller'], broken['valid']) == ('pi', False)
    assert broken['reason'].startswith(
        'incomplete: 60 of 60 steps: if its recorder still runs, stop'
    )
    assert set(broken['metrics']) == set(whole['metrics'])
    assert set(broken['metrics'].values()) | set(broken['figures'].values()) == {None}
    assert 'incomplete: 60 of 60 steps' in captured.err


def test_signals_come_as_csv_to_the_last_bit(bags, trajectory, tmp_path):
    bags.write(trajectory, folder='demo/pi')
    assert main([str(tmp_path / 'demo'), '--signals-csv', str(tmp_path / 'csv')]) == 0
    rows = list(csv.DictReader((tmp_path / 'csv' / 'pi.csv').open()))
    written = {name: [float(row[name]) for row in rows] for name in rows[0]}
    signals = csv_signals(trajectory)
    assert list(written) == list(signals)
    assert written == {name: values.tolist() for name, values in signals.items()}


def test_csv_has_one_row_per_bag(bags, trajectory, capsys):
    assert main([str(bags.write(together(trajectory))), '--csv', '-']) == 0
    (row,) = csv.DictReader(io.StringIO(capsys.readouterr().out))
    assert row['controller'] == 'pi'
    assert row['steps'] == '60'
    assert (row['state'], row['why'], row['friction_work_j']) == ('engaged', '', '0.0')
    assert row['resends'] == ''


@pytest.mark.parametrize('arguments', [['nothing-here'], ['--json', '-', '--csv', '-', '.']])
def test_a_mistake_gives_1_and_one_line(arguments, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == ''
    assert captured.err.startswith('ddct score: ')
    assert captured.err.count('\n') == 1


def test_a_folder_without_bags_is_a_mistake(tmp_path, capsys):
    assert main([str(tmp_path)]) == 1
    assert 'no .mcap file' in capsys.readouterr().err


def test_an_unwritable_output_is_a_mistake(bags, trajectory, tmp_path, capsys):
    bag = bags.write(trajectory)
    assert main([str(bag), '--csv', str(tmp_path / 'missing' / 'scores.csv')]) == 1
    assert 'cannot be written (No such file or directory)' in capsys.readouterr().err


def test_help_has_examples(capsys):
    with pytest.raises(SystemExit) as end:
        main(['--help'])
    assert end.value.code == 0
    assert 'ddct score runs/demo' in capsys.readouterr().out


def test_scoring_needs_no_ros(bags, trajectory):
    bag = bags.write(trajectory)
    program = (
        'import sys; from ddct_bringup.programs.score import main; '
        f'code = main([{str(bag)!r}]); '
        "sys.exit(code or ('rclpy' in sys.modules) or ('sensor_msgs' in sys.modules))"
    )
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))}
    result = subprocess.run(
        [sys.executable, '-c', program],
        env=environment,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
    )
    assert result.returncode == 0, result.stderr
