# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`design loop-shaping`: the thesis's workflow, a controller of one's own, and its errors."""

import argparse
import json

import pytest

from ddct_controllers.design.drawing import charts
from ddct_controllers.from_file.designed import load_designed
from ddct_controllers.registry import make_controller
from ddct_controllers.workflows import loop_shaping_command
from ddct_plant.program.command_line import run_program
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings

pytestmark = pytest.mark.slow

OWN = ['loop-shaping', '--rise-time', '0.6', '--overshoot', '14']


def main(argv: list[str]) -> int:
    """Run the subcommand as `design` does."""

    def run(arguments: list[str]) -> int:
        parser = argparse.ArgumentParser(prog='ddct design')
        loop_shaping_command.add_parser(parser.add_subparsers(required=True))
        options = parser.parse_args(arguments)
        return options.run(options)

    return run_program('ddct design', run, argv)


@pytest.fixture
def without_charts(monkeypatch):
    """Let no chart be drawn, which takes longer than the design."""
    monkeypatch.setattr(charts, 'write_design_charts', lambda *arguments: None)


def test_without_options_it_prints_the_thesis_workflow(capsys):
    assert main(['loop-shaping']) == 0
    printed = capsys.readouterr().out
    rows = [line.split() for line in printed.splitlines()]
    assert any(row[:7] == ['|K_c|', '=', '0.3:', 'G_c1', '0', '7.08', '55.0'] for row in rows)
    assert ['2.2,', 'G_c1', '0.25', '14', '0.5305', '1.427', '1.112'] in [row[:7] for row in rows]


def test_json_on_standard_output_is_alone(capsys):
    assert main(['loop-shaping', '--json', '-']) == 0
    record = json.loads(capsys.readouterr().out)
    assert set(record) == {'network_steps', 'placement', 'loops'}
    assert [row['unstable_poles'] for row in record['network_steps']] == [2, 0, 2, 0, 0]


def test_a_design_is_written_with_charts_and_is_a_controller(tmp_path, capsys):
    pytest.importorskip('matplotlib')
    assert main([*OWN, '--name', 'calm', '--out', str(tmp_path / 'new')]) == 0
    path = tmp_path / 'new' / 'calm.yaml'
    assert f'compare --controllers {path}' in capsys.readouterr().out
    charts = {
        f'calm_{chart}.{ending}'
        for chart in ('nyquist', 'nichols', 'step')
        for ending in ('png', 'svg', 'csv')
    }
    assert {file.name for file in path.parent.iterdir()} == {'calm.yaml', *charts}
    designed = load_designed(str(path))
    assert designed.provenance['specifications']['rise_time_s'] == 0.6
    assert designed.provenance['sampled_loop']['rise_time_s'] <= 0.6
    assert designed.provenance['sampled_loop']['stable']
    make_controller(str(path), KnownSettings(load_scenario('thesis')))


@pytest.mark.usefixtures('without_charts')
def test_an_earlier_design_is_replaced_only_with_overwrite(tmp_path, capsys):
    command = [*OWN, '--out', str(tmp_path)]
    assert main(command) == 0
    assert main(command) == 1
    assert 'exists already: choose another --name or add --overwrite' in capsys.readouterr().err
    assert main([*command, '--overwrite']) == 0


def test_a_design_for_another_car_names_it_and_differs(capsys):
    found = {}
    for car in ('c635', 'city7'):
        assert main([*OWN, '--car', car, '--json', '-']) == 0
        found[car] = json.loads(capsys.readouterr().out)
    assert found['city7']['scenario'] == 'thesis_city7'
    assert found['city7']['controller'] != found['c635']['controller']


def test_overwrite_keeps_a_file_that_is_no_controller(tmp_path, capsys):
    (tmp_path / 'mine.yaml').write_text('something: else\n', encoding='utf-8')
    assert main([*OWN, '--out', str(tmp_path), '--overwrite']) == 1
    assert 'key name is missing' in capsys.readouterr().err
    assert (tmp_path / 'mine.yaml').read_text(encoding='utf-8') == 'something: else\n'


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (['--rise-time', '0.6'], '--overshoot is missing'),
        (['--overshoot', '14'], '--rise-time is missing'),
        (['--out', 'x'], '--out needs specifications'),
        (['--car', 'city7'], '--car needs specifications'),
        (['--set', 'gear=2'], '--set needs specifications'),
        (['--name', 'x'], '--name needs specifications'),
        (['--rise-time', '-1', '--overshoot', '14'], 'rise time is -1 s: it must be above 0'),
        (['--rise-time', '0.6', '--overshoot', '0'], 'overshoot is 0 %'),
        (['--rise-time', '0.6', '--overshoot', '140'], 'overshoot is 140 %'),
        (['--rise-time', '0.05', '--overshoot', '14'], 'allow 24.5 rad/s'),
        ([*OWN[1:], '--name', 'ls8'], '--name ls8 is taken'),
        ([*OWN[1:], '--name', 'No Name'], "controller name 'No Name'"),
    ],
)
def test_a_users_mistake_is_one_line(options, complaint, capsys):
    assert main(['loop-shaping', *options]) == 1
    lines = [line for line in capsys.readouterr().err.splitlines() if 'searching' not in line]
    assert len(lines) == 1
    assert lines[0].startswith('ddct design: ')
    assert complaint in lines[0]


def test_a_folder_that_cannot_be_made_is_named(tmp_path, capsys):
    (tmp_path / 'file').write_text('', encoding='utf-8')
    assert main([*OWN, '--out', str(tmp_path / 'file' / 'x')]) == 1
    assert 'cannot be made (Not a directory)' in capsys.readouterr().err


def test_a_margin_of_a_design_is_not_specified_and_the_table_has_the_reason(capsys):
    assert main([*OWN, '--disturbance', 'none']) == 0
    lines = [' '.join(line.split()) for line in capsys.readouterr().out.splitlines()]
    for quantity in ('phase', 'gain', 'delay'):
        assert any(line.startswith(f'{quantity} margin - ') for line in lines)
    assert '- follows from the others' in lines


def test_a_ramp_disturbance_needs_two_integrators_and_none_needs_none(capsys):
    for disturbance, integrators in (('ramp', 2), ('none', 0)):
        assert main([*OWN, '--disturbance', disturbance, '--json', '-']) == 0
        record = json.loads(capsys.readouterr().out)
        assert record['integrators'] == integrators
        assert record['controller']['denominator'].count(0.0) == integrators
