# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plant on paper is the plant that runs, in every format."""

import ast
import json
import re
from pathlib import Path

import numpy as np
import pytest

from ddct_controllers.workflows.design_program import main
from ddct_controllers.workflows.plant_on_paper import MATRICES, plant_on_paper
from ddct_controllers.workflows.plant_text import factored_text
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario

STIFFER = ['driveline.halfshaft_stiffness=8000']


def test_the_actuator_is_the_scenarios(capsys: pytest.CaptureFixture[str]) -> None:
    import control

    changes = ['actuator.delay_s=0.023', 'actuator.bandwidth_factor=1.3']
    scenario = load_scenario('thesis', changes)
    paper = plant_on_paper(scenario)
    assert paper.actuator_delay_s == 0.023
    function, running = paper.transfer_functions['G_a'], scenario.actuator.dynamics()
    w = np.logspace(-1, 3, 50)
    ours = control.tf(function.num, function.den)(1j * w)
    theirs = control.ss(running.a, running.b, running.c, running.d)(1j * w)
    np.testing.assert_allclose(ours, theirs, rtol=1e-9)
    assert main(['plant', *(f'--set={each}' for each in changes)]) == 0
    assert 'a delay of 0.023 s before G_a' in capsys.readouterr().out


def test_the_transfer_functions_are_those_of_the_state_space() -> None:
    import control

    paper = plant_on_paper(load_scenario('thesis', STIFFER))
    space = paper.state_space
    system = control.ss(*(getattr(space, name) for name in MATRICES))
    for name, column in (('P_1', 0), ('P_2', 1), ('P_3', 2)):
        function = paper.transfer_functions[name]
        w = np.logspace(-2, 3, 50)
        ours = control.tf(function.num, function.den)(1j * w)
        np.testing.assert_allclose(system(1j * w)[0, column], ours, rtol=1e-6)


def test_the_functions_read_as_the_thesis_prints_them() -> None:
    functions = plant_on_paper(load_scenario('thesis')).transfer_functions
    assert factored_text(functions['P_1'].function) == '4.00039 / [s]'
    assert factored_text(functions['G_a'].function) == (
        '25.305 (s + 138) (s^2 - 161.3 s + 31340) / '
        '[(s^2 + 82.23 s + 2563) (s^2 + 134.1 s + 42700)]'
    )
    gain, dc = functions['G_a'].num, functions['G_a'].den
    assert gain[-1] / dc[-1] == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize('equilibrium', ['thesis', 'full'])
def test_the_factors_add_up_to_the_static_torque(equilibrium: str) -> None:
    scenario = load_scenario('thesis', [f'equilibrium={equilibrium}'])
    factors = {name: each.factor for name, each in plant_on_paper(scenario).c_fol.items()}
    p, w_m, w_p = scenario.driveline, 200.0, 150.0
    if equilibrium == 'thesis':
        expected = constant_slip_torque(p, 150.0, 300.0)
        assert factors['w_m'] == factors['w_p'] == 0.0
    else:
        load = 300.0 + p.gear.total_ratio * p.shaft_damping * w_p
        expected = constant_slip_torque(p, 150.0 - p.engine_damping * w_m, load)
    signals = {'C_m': 150.0, 'C_load': 300.0, 'w_m': w_m, 'w_p': w_p}
    total = sum(factors[name] * value for name, value in signals.items())
    assert total == pytest.approx(expected, rel=1e-12)


def test_every_export_holds_the_same_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from scipy.io import loadmat

    exports = [f'--export={tmp_path / name}' for name in ('p.json', 'p.m', 'p.mat')]
    assert main(['plant', '--set', *STIFFER, *exports, '--json', '-']) == 0
    paper = json.loads(capsys.readouterr().out)
    assert json.loads((tmp_path / 'p.json').read_text()) == paper
    script = (tmp_path / 'p.m').read_text()
    mat = loadmat(tmp_path / 'p.mat', squeeze_me=True)
    model = driveline_matrices(load_scenario('thesis', STIFFER).driveline)
    for name, matrix in zip('ABCD', (model.a, model.b, model.c, model.d), strict=True):
        written = re.search(rf'^{name} = \[(.*)\];$', script, re.MULTILINE)
        assert written
        rows = [[ast.literal_eval(n) for n in row.split()] for row in written[1].split(';')]
        np.testing.assert_array_equal(rows, matrix)
        np.testing.assert_array_equal(mat[name], matrix)
    p_2 = paper['transfer_functions']['P_2']
    assert f'P_2 = tf([{" ".join(map(repr, p_2["num"]))}]' in script
    np.testing.assert_array_equal(mat['P_2']['num'].item(), p_2['num'])
    assert 'k_sa = 8000.0;' in script
    assert mat['k_sa'] == 8000.0


@pytest.mark.parametrize(
    ('export', 'complaint'),
    [('plant.csv', 'must end in one of .json, .m, .mat'), ('none/plant.m', 'there is no folder')],
)
def test_a_bad_file_is_refused_before_anything_is_printed(
    export: str, complaint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['plant', '--export', export]) == 1
    printed = capsys.readouterr()
    assert complaint in printed.err
    assert printed.out == ''
