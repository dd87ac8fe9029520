# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`design h-infinity` with the sampled weights, with the LMI method, and in another process."""

import json
import subprocess
import sys

import numpy as np
import pytest

from ddct_controllers.from_file.designed import load_designed
from ddct_controllers.registry import make_controller
from ddct_controllers.synthesised import SYNTHESISED, synthesised_design
from ddct_controllers.workflows.design_program import main
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

SETTINGS = RunSettings(load_scenario('thesis'))


@pytest.mark.parametrize('weights', ['sampled'])
def test_the_controller_it_writes_runs_as_designed(tmp_path, capsys, weights):
    """It has the G_c(z) of the registry to the last bit, and three charts."""
    options = ['h-infinity', '--weights', weights, '--name', 'mine', '--out', str(tmp_path)]
    assert main([*options, '--write-anyway']) == 0
    path = tmp_path / 'mine.yaml'
    assert f'bringup --controller {path}' in capsys.readouterr().out
    built = make_controller(str(path), SETTINGS).linear_model()
    expected = synthesised_design(f'hinf_{weights}').sampled
    for part in 'abcd':
        assert np.array_equal(getattr(built, part), getattr(expected, part))
    provenance = load_designed(str(path)).provenance
    assert provenance['weights']['recipe'] == weights
    assert provenance['lacks']
    assert len(list(tmp_path.glob('mine_*.png'))) == 3


def test_the_lmi_method_gives_nearly_the_same_level(capsys):
    pytest.importorskip('clarabel', reason='the LMI method needs clarabel')
    levels = []
    for method in ('lmi', 'riccati'):
        assert main(['h-infinity', '--method', method, '--json', '-']) == 0
        levels.append(json.loads(capsys.readouterr().out)['synthesis']['optimum'])
    assert levels[0] == pytest.approx(levels[1], rel=2e-3)


def test_another_process_synthesises_the_same_controller_to_the_bit():
    code = (
        'from ddct_controllers.synthesised import *\n'
        'for name in SYNTHESISED:\n'
        '    model = synthesised_design(name).sampled\n'
        '    print(*(getattr(model, part).tobytes().hex() for part in "abcd"))\n'
    )
    found = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=True, timeout=120
    )
    expected = [
        ' '.join(
            getattr(synthesised_design(name).sampled, part).tobytes().hex() for part in 'abcd'
        )
        for name in SYNTHESISED
    ]
    assert found.stdout.split('\n')[:-1] == expected
