# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`sweep` prints, writes and draws the results of the same runs alone."""

import csv
import json
from pathlib import Path

import pytest
from by_schema import require_schema
from refusals import refused

from ddct_bringup import api
from ddct_bringup.api.shell.sweeps import planned_sweep
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.programs.sweep import main
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.scores.document import run_entry
from ddct_bringup.sweep.as_campaign import specification_of
from ddct_bringup.sweep.axis import axis_of
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_python import chosen_from
from ddct_plant.files.json_records import to_json
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml
from ddct_plant.scenario.file import ScenarioFile

SHORT_S = 1.0
SHORT = ['--duration', str(SHORT_S)]
OUTCOME = ('state', 'why', 'figures', 'limits')
UNSTABLE = """\
name: unstable
units: {input: rpm, output: N m}
polynomial: {num: [-1.0], den: [1, -900]}
"""


@pytest.fixture(scope='module')
def swept(tmp_path_factory):
    """Return the output, exit code and JSON of a sweep of two controllers over the mass."""
    file = tmp_path_factory.mktemp('sweep') / 'rows.json'
    over = ['--over', 'vehicle.mass_kg=1200,1800', '--controllers', 'pi,ls8']
    code = main([*over, *SHORT, '--wear-gain', '0.9', '--json', str(file)])
    return code, json.loads(file.read_text())


def test_rows_are_those_of_the_runs_alone_with_what_belongs_to_the_key(swept):
    code, document = swept
    assert code == 0
    rows = document['rows']
    assert [(row['controller'], row['over']['vehicle.mass_kg']) for row in rows] == [
        ('pi', 1200.0),
        ('pi', 1800.0),
        ('ls8', 1200.0),
        ('ls8', 1800.0),
    ]
    row = rows[3]
    base = RunBase(
        ScenarioFile.read('thesis'), {'duration_s': SHORT_S}, {'wear_gain': 0.9}, ['ls8']
    )
    settings = base.at({'vehicle.mass_kg': 1800.0})
    alone = to_json(run_entry(scored_headless(settings, 'ls8', packaged_limits())))
    assert {key: row[key] for key in OUTCOME} == {key: alone[key] for key in OUTCOME}
    assert row['metrics']['slip_final_rpm'] == alone['metrics']['slip_final_rpm']
    assert row['scenario_changes'] == list(alone['scenario_changes'])
    assert any(
        change.startswith('driveline.vehicle_inertia') for change in row['scenario_changes']
    )
    assert rows[2]['metrics']['slip_final_rpm'] != row['metrics']['slip_final_rpm']


def test_the_document_has_the_varied_keys(swept):
    document = swept[1]
    require_schema('sweep', document)
    assert document['over'] == [
        {'key': 'vehicle.mass_kg', 'unit': 'kg', 'values': [1200.0, 1800.0]}
    ]
    assert (document['schema_version'], document['controllers']) == (1, ['pi', 'ls8'])
    assert document['limits']['name'] == 'packaged'


@pytest.mark.process
def test_the_table_has_a_row_per_run_and_fits_a_terminal(capsys):
    over = ['--over', 'load.slope_rad=0:0.1:2', '--over', 'wear_gain=0.8,1']
    assert main([*over, '--controllers', 'ls8', *SHORT]) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = [line.split() for line in lines if line.startswith('  ls8')]
    assert [row[1:3] for row in rows] == [['0', '0.8'], ['0', '1'], ['0.1', '0.8'], ['0.1', '1']]
    assert {row[-1] for row in rows} <= {'engaged', 'not_engaged'}
    assert max(map(len, lines)) <= 120


@pytest.mark.process
def test_the_csv_has_the_row_of_each_run_with_what_was_varied(swept, capsys):
    over = ['--over', 'vehicle.mass_kg=1200,1800', '--controllers', 'pi,ls8']
    assert main([*over, *SHORT, '--wear-gain', '0.9', '--csv', '-']) == 0
    printed = capsys.readouterr()
    rows = list(csv.DictReader(printed.out.splitlines()))
    wanted = swept[1]['rows']
    assert len(rows) == len(wanted) == 4
    for row, run in zip(rows, wanted, strict=True):
        assert row['controller'] == run['controller']
        assert float(row['vehicle.mass_kg']) == run['over']['vehicle.mass_kg']
        assert row['state'] == run['state']
        assert float(row['slip_final_rpm']) == run['metrics']['slip_final_rpm']
    assert 'std w_sr' in printed.err, 'the table goes to standard error then'


@pytest.mark.process
def test_a_run_that_fails_is_a_row_with_its_reason_and_the_exit_code_is_1(tmp_path, capsys):
    file = tmp_path / 'unstable.yaml'
    file.write_text(UNSTABLE)
    picture = tmp_path / 'sweep.svg'
    over = ['--over', 'wear_gain=0.9,1', '--controllers', f'pi,{file}']
    assert main([*over, '--figure', str(picture), '--json', '-']) == 1
    printed = capsys.readouterr()
    rows = json.loads(printed.out)['rows']
    assert [row['valid'] for row in rows] == [True, True, False, False]
    assert rows[2]['state'] == 'invalid'
    assert rows[2]['metrics']['engagement_time_s'] is None
    _, _, note = ' '.join(printed.err.split()).partition('is not valid: ')
    assert note.startswith(' '.join(rows[2]['reason'].split()))
    assert '(at wear_gain=0.9; wear_gain=1)' in note
    assert 'ddct sweep: 2 of 4 runs are not valid' in printed.err
    assert 'invalid' in picture.read_text()


def test_its_specification_is_a_campaign_with_the_same_runs():
    """What is given for all runs is known or of the case as in the sweep, sensors' seed too."""
    given = {
        'scenario': 'thesis_sticking',
        'set': {'load.slope_rad': 0.05, 'sensors.shaft_speed.noise_rad_s': 0.1},
        'case': {'vehicle.mass_kg': 1700.0},
        'wear_gain': 0.9,
        'architecture': 'detailed',
        'seed': 3,
    }
    axes = [axis_of('gear=1,2'), axis_of('driveline.halfshaft_stiffness=4000:6000:2')]
    sweep = planned_sweep(['pi', 'ls8'], axes, packaged_limits(), print, **given)
    spec = spec_of(parse_yaml(dump_yaml(specification_of(sweep))), Path())
    campaign = Campaign(spec)
    assert campaign.runs == len(sweep)
    for index in range(len(sweep)):
        mine, again = (runs.run(index) for runs in (sweep.run_set, campaign))
        assert (mine.settings, mine.controller.name) == (again.settings, again.controller.name)


BAD = {
    'no over': ([], '--over is missing'),
    'refused by the scenario': (['--over', 'vehicle.mass_kg=1000,-1'], 'vehicle.mass_kg is -1'),
    'unknown deep key': (['--over', 'vehicle.mass=1:2:2'], 'did you mean vehicle.mass_kg'),
    'out of range': (['--over', 'wear_gain=1:4:3'], 'wear_gain is 4: it must be at most 3'),
    'no whole gear': (['--over', 'gear=1:2:3'], 'gear is 1.5: give a whole number'),
    'a key of the graph': (['--over', 'wear_gain=1,2', '--mode', 'realtime'], 'mode is realtime'),
    'mode varied': (['--over', 'mode=lockstep,realtime'], 'unknown key mode'),
    'scenario varied': (['--over', 'scenario=thesis,launch'], 'give one by --scenario'),
    'a list in one': (['--over', 'engine.time_s=1,2'], 'engine.time_s is 1.0: give a list'),
    'a key twice': (['--over', 'gear=1,2', '--over', 'gear=3'], 'names gear twice'),
    'too many points': (
        ['--over', 'wear_gain=1:2:999', '--over', 'load.slope_rad=0:0.1:11'],
        '10989 points: at most 10000',
    ),
    'unknown controller': (['--over', 'gear=1', '--controllers', 'nope'], "'nope'"),
    'refused option': (['--over', 'controllers.pi.integral_gain=x,1'], 'integral_gain'),
    'unknown after a heading': (['--over', 'gear=1', '--metrics', 't_a,spets'], 'metric spets'),
    'unknown metric': (['--over', 'gear=1', '--metrics', 'steps,spets'], 'did you mean steps'),
    'no metric': (['--over', 'gear=1', '--metrics', ','], '--metrics is empty'),
    'no picture': (['--over', 'gear=1', '--figure', 'wear.pdf'], '.png, .svg or .html'),
    'no folder': (['--over', 'gear=1', '--figure', 'no/such/wear.png'], 'no folder'),
    'no folder for the CSV': (['--over', 'gear=1', '--csv', 'no/such/x'], 'no folder'),
    'two on stdout': (['--over', 'gear=1', '--csv', '-', '--json', '-'], 'both want standard'),
    'no folder for rows': (['--over', 'gear=1', '--json', 'no/such/x'], 'no folder'),
    'three keys in a figure': (
        ['--over', 'gear=1', '--over', 'wear_gain=1', '--over', 'seed=1', '--figure', 'x.png'],
        'one or two keys, not 3',
    ),
}


@pytest.mark.parametrize(('options', 'words'), BAD.values(), ids=BAD)
def test_a_mistake_is_one_line_before_anything_runs(options, words, capsys):
    given = options if '--controllers' in options else [*options, '--controllers', 'pi']
    assert main(given) == 1
    printed = capsys.readouterr()
    (line,) = printed.err.splitlines()
    assert line.startswith('ddct sweep: ')
    assert words in line
    assert not printed.out


class Gained(api.Controller):
    options = {'gain': api.Option(0.1, 'torque per slip error', 'N m/rpm', at_least=0.0)}

    def __init__(self, context):
        self.gain = context.gains['gain']

    def reset(self):
        pass

    def update(self, measurement):
        return api.Command(-self.gain * measurement.slip_error_rpm)


@pytest.mark.process
def test_an_option_of_ones_own_controller_can_be_swept():
    mine = chosen_from(Gained, 'mine')
    rows = api.sweep([mine], {'controllers.mine.gain': [0.05, 0.2]}, duration=SHORT_S)
    alone = api.run(mine, set={'controllers.mine.gain': 0.2}, duration=SHORT_S)
    assert rows['slip_final_rpm'][1] == alone.metrics['slip_final_rpm']
    assert rows['slip_final_rpm'][0] != rows['slip_final_rpm'][1]
    with refused(api.ParameterError, 'controllers.none'):
        api.sweep([mine], {'controllers.none.gain': [0.1]})


class Diverging(api.Controller):
    def reset(self):
        pass

    def update(self, measurement):
        return api.Command(float('nan'))


@pytest.mark.process
def test_a_sweep_from_python_is_a_table_that_takes_objects_and_keeps_failures():
    rows = api.sweep(
        ['pi', chosen_from(Diverging, 'mine')], {'wear_gain': [0.8, 1.0]}, duration=SHORT_S
    )
    assert rows['controller'].tolist() == ['pi', 'pi', 'mine', 'mine']
    assert rows['wear_gain'].tolist() == [0.8, 1.0, 0.8, 1.0]
    assert rows['valid'].tolist() == [True, True, False, False]
    assert rows['state'].tolist()[2:] == ['invalid', 'invalid']
    alone = api.run('pi', wear_gain=0.8, duration=SHORT_S)
    assert rows['slip_final_rpm'][0] == alone.metrics['slip_final_rpm']
    with refused(api.ParameterError, 'wear_gian'):
        api.sweep('pi', {'wear_gian': '1:2:3'})
