# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The Python interface: runs, their results, and arguments that are refused."""

import hashlib
import json
import pickle
import threading
import warnings
from dataclasses import asdict, replace
from importlib.metadata import EntryPoint, EntryPoints
from importlib.resources import files

import numpy as np
import pytest
from refusals import refused

from ddct_bringup import api
from ddct_bringup.api import run_and_load
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.documents.palette import looks
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.programs.bringup import main as bringup
from ddct_bringup.programs.score import main as score
from ddct_bringup.run.description import custom_data
from ddct_bringup.run.headless import run_headless
from ddct_controllers import plugins, registry
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SHORT_S = 2.0


def test_the_least_is_beside_the_peak_jerk_where_it_is_requested():
    added = {'peak_jerk_over_least', 'least_is_bound'}
    plain, run = api.run('ls8'), api.run('ls8', floors=True)
    assert {plain.figures[key] for key in added} == {None}
    assert run.figures['peak_jerk_over_least'] > 1.0
    assert run.figures['least_is_bound'] is True
    kept = plain.figures.keys() - added
    assert {key: run.figures[key] for key in kept} == {key: plain.figures[key] for key in kept}
    assert (run.state, run.limits) == (plain.state, plain.limits)
    (row,) = api.table(run).to_dict('records')
    assert {key: row[key] for key in added} == {key: run.figures[key] for key in added}


class Soft(api.Controller):
    """Controller with one option and a state that a run must reset."""

    options = {'gain': api.Option(0.1, 'torque per slip error', 'N m/rpm')}

    def __init__(self, context):
        self._gain = context.gains['gain']
        self.updates = 0

    def reset(self):
        self.updates = 0

    def update(self, measurement):
        self.updates += 1
        return api.Command(-self._gain * measurement.slip_error_rpm)


class Failing(Soft):
    def update(self, measurement):
        return api.Command(float('nan'))


@pytest.fixture(scope='module')
def worn():
    return api.run('ls8', wear_gain=0.7, duration=3.0)


def test_a_run_is_that_of_the_headless_loop(worn):
    settings = RunSettings(
        KnownSettings(load_scenario('thesis', ['duration_s=3.0'])), CaseSettings(wear_gain=0.7)
    )
    assert worn.trajectory.sha256() == run_headless(settings, 'ls8').sha256()
    assert (worn.settings, worn.controller, worn.path) == (settings, 'ls8', None)


def test_figures_metrics_state_and_limits_are_those_of_the_programs(worn, tmp_path, capsys):
    options = ['--wear-gain', '0.7', '--duration', '3', '--headless', '--out', str(tmp_path)]
    assert bringup(['--controller', 'ls8', *options]) == 0
    capsys.readouterr()
    assert score([str(tmp_path / 'ls8'), '--floors', 'none', '--json', '-']) == 0
    (entry,) = json.loads(capsys.readouterr().out)['runs']
    untimed = {name for name in entry['metrics'] if not METRICS[name].from_timing}
    assert {name: worn.metrics[name] for name in untimed} == {
        name: entry['metrics'][name] for name in untimed
    }
    assert worn.figures == entry['figures']
    assert (worn.state, worn.why) == (entry['state'], entry['why'])
    assert [asdict(each) for each in worn.limits] == entry['limits']
    assert (worn.valid, worn.reason) == (entry['valid'], entry['reason']) == (True, '')


def test_a_kept_run_is_the_bag_of_bringup_and_loads_to_an_equal_run(worn, tmp_path):
    kept = api.run('ls8', wear_gain=0.7, duration=3.0, out=tmp_path / 'ours')
    options = ['--wear-gain', '0.7', '--duration', '3', '--headless']
    assert bringup(['--controller', 'ls8', *options, '--out', str(tmp_path / 'theirs')]) == 0
    assert kept.path == tmp_path / 'ours' / 'ls8' / 'ls8_0.mcap'
    theirs = (tmp_path / 'theirs' / 'ls8' / 'ls8_0.mcap').read_bytes()
    assert kept.path.read_bytes() == theirs
    loaded = api.load(kept.path.parent)
    assert loaded.trajectory.sha256() == worn.trajectory.sha256()
    assert loaded.metrics == kept.metrics
    assert loaded.settings == worn.settings
    assert loaded.chosen == worn.chosen == 'ls8'
    with pytest.raises(api.DdctError, match='already holds a result'):
        api.run('ls8', out=tmp_path / 'ours')


def test_frequency_evidence_is_that_of_the_loop_and_none_without_a_linear_model(worn):
    evidence = worn.frequency()
    assert evidence['controller'] == 'ls8'
    assert [point['wear_gain'] for point in evidence['wear']] == [0.7, 1.0, 1.3]
    assert evidence['nominal']['stable']
    assert api.run(Soft, duration=SHORT_S).frequency()['linear'] is False


def test_a_run_is_printed_as_one_line(worn):
    assert repr(worn) == ('<Run of ls8: thesis, 3 s, wear gain 0.7, engaged, valid>')
    failed = replace(worn.scores, valid=False, reason='it crashed')
    crashed = replace(worn, scored=replace(worn.scored, scores=failed))
    assert repr([crashed]).endswith(', not valid: it crashed>]')


def test_the_bag_of_a_kept_run_names_the_controller_file(tmp_path):
    file = tmp_path / 'mine.yaml'
    file.write_text(
        'name: mine\nunits: {input: rpm, output: N m}\npolynomial: {num: [-0.1], den: [1.0]}\n'
    )
    kept = api.run(file, duration=SHORT_S, out=tmp_path / 'runs')
    told = read_bag(kept.path).run_info['/controller']
    assert told['controller_file_sha256'] == hashlib.sha256(file.read_bytes()).hexdigest()


def test_a_dataframe_has_the_signals_by_time(worn):
    frame = worn.dataframe()
    assert frame.index.name == 'time_s'
    assert frame.index.tolist() == worn.trajectory.time_s.tolist()
    assert frame['slip_speed_rad_s'].tolist() == worn.trajectory.slip_speed.tolist()
    assert frame['wheel_speed_rad_s'].tolist() == worn.trajectory.joint_speed[:, 2].tolist()


def test_a_table_has_a_row_per_run_with_metrics_and_state(worn):
    assert len(api.table(worn)) == 1
    rows = api.table([worn, worn])
    assert rows['controller'].tolist() == ['ls8', 'ls8']
    assert rows['slip_final_rpm'].tolist() == 2 * [worn.metrics['slip_final_rpm']]
    assert rows['state'].tolist() == 2 * [worn.state]


def test_a_figure_has_a_line_per_run_in_each_chart(worn):
    other = api.run('pi', duration=3.0)
    charts = api.figure([worn, other], quantities=['w_d', 'C_m']).axes
    assert [axes.get_ylabel() for axes in charts] == ['$w_{d}$, rpm', '$C_{m}$, N m']
    labels = [line.get_label() for line in charts[0].lines]
    assert labels == ['ls8, wear 0.7', 'pi, wear 1']
    colours = [line.get_color() for axes in charts for line in axes.lines]
    assert colours == [look.colour for look in looks(2)] * 2
    drawn = np.asarray(charts[1].lines[0].get_ydata())
    assert drawn.tolist() == worn.trajectory.engine_torque.tolist()
    with refused(api.ParameterError, key='w_x'):
        api.figure(worn, quantities=['w_x'])


def test_controllers_are_compared_with_the_options_of_each():
    runs = api.compare(['pi', Soft], duration=SHORT_S, set={'controllers.Soft.gain': 0.3})
    assert [each.controller for each in runs] == ['pi', 'Soft']
    alone = api.run(Soft, duration=SHORT_S, set={'controllers.Soft.gain': 0.3})
    assert runs[1].trajectory.sha256() == alone.trajectory.sha256()
    assert alone.trajectory.sha256() != api.run(Soft, duration=SHORT_S).trajectory.sha256()


def test_controllers_may_be_given_as_on_the_command_line():
    runs = api.compare('pi, ls8,', duration=SHORT_S)
    assert [each.controller for each in runs] == ['pi', 'ls8']
    with refused(api.ParameterError, 'controllers'):
        api.compare(' ')


def test_a_broken_controller_of_another_package_does_not_stop_the_comparison_of_all(
    monkeypatch, tmp_path
):
    points = [
        EntryPoint('absent', 'no_such_package:make', plugins.CONTROLLERS.group),
        EntryPoint('soft', f'{__name__}:Soft', plugins.CONTROLLERS.group),
    ]
    monkeypatch.setattr(plugins, '_installed', lambda _: EntryPoints(points))
    monkeypatch.setattr(registry, 'own_controller_names', lambda: ['pi'])
    with pytest.warns(UserWarning, match="'absent'.*no_such_package.*; left out") as warned:
        runs = api.compare('all', duration=SHORT_S, out=tmp_path, wear_gain=0.9)
    assert [each.controller for each in runs] == ['pi', 'soft']
    assert [each.filename for each in warned] == [__file__]
    with refused(api.DdctError, 'no_such_package:make', place="controller 'absent'"):
        api.compare('pi,absent', duration=SHORT_S)


def test_a_run_that_is_not_kept_has_no_path_whatever_lies_beside(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert api.run('pi', duration=SHORT_S, out='.').path is not None
    assert api.run('pi', duration=SHORT_S).path is None


def test_a_mapping_names_the_controllers():
    soft = Soft(type('Context', (), {'gains': {'gain': 0.2}})())
    runs = api.compare({'first': soft, 'second': Soft}, duration=SHORT_S)
    assert [each.controller for each in runs] == ['first', 'second']
    again = api.run(soft, duration=SHORT_S, name='first')
    assert again.trajectory.sha256() == runs[0].trajectory.sha256()


def test_numbers_of_numpy_are_taken_as_pythons(worn):
    same = api.run('ls8', wear_gain=np.float64(0.7), duration=np.float64(3.0), seed=np.int64(0))
    assert same.recording.run_info == worn.recording.run_info
    assert same.recording.custom_data == worn.recording.custom_data


def test_adjusted_scenario_values_give_a_warning_and_nothing_is_printed(capfd):
    for start in (api.run, api.compare):
        with pytest.warns(UserWarning, match='scenario thesis: '):
            start('pi', duration=SHORT_S, set={'vehicle.mass_kg': 200.0})
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        api.run('pi', duration=SHORT_S)
    assert capfd.readouterr() == ('', '')


def test_a_run_of_a_named_controller_goes_between_processes(worn):
    copy = pickle.loads(pickle.dumps(worn))
    assert copy.trajectory.sha256() == worn.trajectory.sha256()
    assert (copy.scores, copy.settings) == (worn.scores, worn.settings)


def test_runs_in_threads_are_those_of_the_main_one(worn):
    found = []

    def simulate():
        found.append(api.run('ls8', wear_gain=0.7, duration=3.0).trajectory.sha256())

    threads = [threading.Thread(target=simulate) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == 2 * [worn.trajectory.sha256()]


@pytest.mark.parametrize(
    ('options', 'key', 'place'),
    [
        ({'wear': 0.7}, 'wear', ''),
        ({'wear_gain': -1.0}, 'wear_gain', ''),
        ({'scenario': 'thesys'}, 'thesys', ''),
        ({'set': ['load.slope_rad=0.1']}, 'set', ''),
        ({'set': {'load.slop_rad': 0.1}}, 'load.slop_rad', 'scenario thesis'),
        ({'set': {'controllers.nobody.gain': 0.1}}, 'controllers.nobody', ''),
        ({'controller': 'nobody'}, 'nobody', ''),
        ({'controller': Failing}, "controller 'Failing': its torque at step 60", ''),
        ({'controller': Soft, 'headless': False}, 'Soft', ''),
        ({'mode': 'realtime'}, 'mode', ''),
        ({'limits': 'no_such.yaml'}, '', 'no_such.yaml'),
    ],
)
def test_an_invalid_argument_is_an_error_that_names_it(options, key, place):
    with refused(api.DdctError, key, place):
        api.run(**{'controller': 'pi', 'duration': SHORT_S, **options})


def test_everything_public_is_there():
    assert [name for name in vars(api)['__all__'] if not hasattr(api, name)] == []


def test_a_run_that_is_not_valid_leaves_a_good_result_as_it_is(tmp_path, monkeypatch):
    good = api.run('ls8', duration=SHORT_S, out=tmp_path)
    before = {file.name: file.read_bytes() for file in good.path.parent.iterdir()}

    def half(plan, folder):
        settings = RunSettings(
            KnownSettings(load_scenario('thesis', [f'duration_s={SHORT_S / 2}']))
        )
        data = custom_data(plan.settings, plan.name, plan.steps)
        info = {'load': {'version': '0.1.0'}}
        write_trajectory(run_headless(settings, 'ls8'), folder, plan.name, data, info)

    monkeypatch.setattr(run_and_load, 'execute', half)
    bad = api.run('ls8', duration=SHORT_S, out=tmp_path, overwrite=True)
    assert not bad.valid
    assert 'ended early' in bad.reason
    assert bad.path.parent == tmp_path / 'ls8.partial'
    after = {file.name: file.read_bytes() for file in good.path.parent.iterdir()}
    assert after == before


def test_a_loaded_run_is_judged_by_the_limits_that_are_given(tmp_path):
    kept = api.run('ls8', duration=SHORT_S, out=tmp_path / 'runs')
    packaged = (files('ddct_bringup.verdict') / 'limits.yaml').read_text(encoding='utf-8')
    mine = tmp_path / 'mine.yaml'
    stricter = '{metric: weighted_acceleration_m_s2, value: 0.001, unit: m/s^2, applies_to: all'
    convention = f'{stricter}, convention: true, reason: to tell it from the packaged one}}'
    mine.write_text(f'{packaged}  - {convention}\n', encoding='utf-8')

    def limit_of(run):
        (found,) = [each for each in run.limits if each.name == 'weighted_acceleration_m_s2']
        return found.limit

    assert limit_of(api.load(kept.path)) == limit_of(kept) > 0.001
    assert limit_of(api.load(kept.path, limits=mine)) == 0.001
