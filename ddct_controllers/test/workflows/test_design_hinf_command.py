# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`design h-infinity`: tables, JSON, files, and errors in one line."""

import json

import pytest
from refusals import refused
from written_hinf import require_written_as_designed

from ddct_controllers.design.drawing import charts
from ddct_controllers.from_file.designed import DesignedController, load_designed
from ddct_controllers.linear import BILINEAR
from ddct_controllers.workflows.design_program import main
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction

pytestmark = pytest.mark.slow

LACKING = [
    'it overshoots by 12.1 %, 10 % are allowed',
    ' of 128 corners (driveline +-20 %, wear 0.7 to 1.3)',
]


@pytest.fixture
def without_charts(monkeypatch):
    """Let no chart be drawn, which takes longer than the design."""
    monkeypatch.setattr(charts, 'write_design_charts', lambda *arguments: None)


def test_it_prints_the_workflow(capsys):
    assert main(['h-infinity']) == 0
    text = capsys.readouterr().out
    for expected in (
        *('Specifications', 'Weights', 'Synthesis', 'Cleaning', 'Controllers', 'Loops', 'Worst'),
        *('2.977', '1.10503', 'poles at -epsilon', '(s^2 + 134.1 s', '+ 4.27e+04)', 'G_c(z)'),
    ):
        assert expected in text


def test_the_json_has_every_figure(capsys):
    assert main(['h-infinity', '--weights', 'sampled', '--json', '-']) == 0
    found = json.loads(capsys.readouterr().out)
    assert found['weights']['hold_and_delay_in_plant'] is True
    assert found['continuous_loop'] is None
    assert found['sampled_loop']['stable'] is True
    assert found['corners']['unstable_corners'] == 0
    assert found['corners']['sensitivity_peak'] < 2.0
    assert found['uncertainty']['largest_error'] == pytest.approx(0.3)
    assert found['uncertainty']['printed_falls_short_by'] == pytest.approx(0.0043, abs=1e-4)
    assert found['synthesis']['gamma'] >= found['synthesis']['lower_bound']
    assert len(found['pulse_transfer_function']['denominator']) > 5


@pytest.mark.nightly
def test_the_controller_it_writes_runs_as_designed(tmp_path, capsys):
    require_written_as_designed(tmp_path, capsys, 'fitted')


@pytest.mark.parametrize(
    ('options', 'lacking'),
    [
        (['--weights', 'thesis', '--rise-time', '0.4', '--overshoot', '10'], LACKING),
        (['--weights', 'sampled'], ['it rises in ', 'it overshoots by 21.8 %, 8 % are allowed']),
    ],
)
def test_a_design_that_falls_short_is_not_written_and_the_error_has_the_reason(
    tmp_path, capsys, options, lacking
):
    command = ['h-infinity', *options, '--out', str(tmp_path / 'designs')]
    assert main(command) == 1
    error = capsys.readouterr().err
    assert error.startswith('ddct design: mine falls short: ') and error.count('\n') == 1
    assert all(words in error for words in lacking)
    assert error.count(';') == len(lacking) - 1
    assert not (tmp_path / 'designs').exists()


def test_it_designs_for_another_car(capsys):
    assert main(['h-infinity', '--car', 'city7']) == 0
    shown = capsys.readouterr()
    assert 'scenario thesis_city7' in shown.out
    assert 'unstable at 40 of 128 corners' in shown.err
    assert shown.err.endswith('; nothing is written\n')


@pytest.mark.usefixtures('without_charts')
def test_a_design_that_meets_its_specifications_is_written(tmp_path, capsys):
    options = ['--weights', 'fitted', '--rise-time', '0.5', '--overshoot', '15']
    assert main(['h-infinity', *options, '--out', str(tmp_path)]) == 0
    assert capsys.readouterr().err == ''
    assert load_designed(str(tmp_path / 'mine.yaml')).provenance['lacks'] == []


@pytest.mark.nightly
def test_specifications_that_are_not_met_are_an_error_also_without_a_file(capsys):
    options = ['h-infinity', '--rise-time', '0.4', '--overshoot', '10']
    assert main(options) == 1
    assert LACKING[0] in capsys.readouterr().err
    assert main([*options, '--write-anyway']) == 0
    assert capsys.readouterr().err.startswith(f'ddct design: mine: {LACKING[0]}')


def test_a_bilinear_controller_comes_back_from_its_file(tmp_path):
    g_c = FactoredTransferFunction(-0.1, (1.0,), (0.0, 5.0))
    path = tmp_path / 'mine.yaml'
    text = DesignedController('mine', g_c, {}, BILINEAR).to_yaml()
    path.write_text(text, encoding='utf-8')
    assert load_designed(str(path)) == DesignedController('mine', g_c, {}, BILINEAR)
    path.write_text(text.replace('bilinear', 'guess'), encoding='utf-8')
    with refused(ParameterError, 'discretisation', place='mine.yaml: line 4'):
        load_designed(str(path))


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (['--rise-time', '0.02'], 'no controller meets the bounds on S and T'),
        (['--rise-time', '0.05'], 'a longer rise time, or take --weights sampled'),
        (['--rise-time', '-1'], 'rise time is -1 s'),
        (['--overshoot', '0.08'], '--overshoot 0.08 is below 1 %: give per cent, such as 8'),
        (['--overshoot', '100'], 'overshoot is 100 %'),
        (['--low-frequency-gain', '0'], 'K, the low-frequency gain of S, is 0'),
        (['--bandwidth', 'nan'], 'w_2 is nan: give a finite number'),
        (['--effort', '0.1'], 'only the sampled design weighs the torque'),
        (['--back-off', '0.5'], 'back-off from the optimum is 0.5'),
        (['--method', 'lmi', '--back-off', '1.1'], '--back-off is for --method riccati'),
        (['--name', 'hinf_sampled'], '--name hinf_sampled is taken'),
    ],
)
def test_a_users_mistake_is_one_line(capsys, options, complaint):
    assert main(['h-infinity', *options]) == 1
    error = capsys.readouterr().err
    assert complaint in error
    assert error.startswith('ddct design: ')
    assert error.count('\n') == 1
