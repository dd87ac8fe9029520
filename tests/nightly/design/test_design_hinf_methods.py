# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`design h-infinity` with the sampled weights, with the LMI method, and in another process."""

import json
import subprocess
import sys

import pytest
from waiting import WITHIN_S
from written_hinf import require_written_as_designed

from ddct_controllers.synthesised import SYNTHESISED, synthesised_design
from ddct_controllers.workflows.design_program import main


def test_the_controller_it_writes_runs_as_designed(tmp_path, capsys):
    require_written_as_designed(tmp_path, capsys, 'sampled')


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
        [sys.executable, '-c', code], capture_output=True, text=True, check=True, timeout=WITHIN_S
    )
    expected = [
        ' '.join(
            getattr(synthesised_design(name).sampled, part).tobytes().hex() for part in 'abcd'
        )
        for name in SYNTHESISED
    ]
    assert found.stdout.split('\n')[:-1] == expected
