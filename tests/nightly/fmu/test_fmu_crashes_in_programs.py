# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An FMU that ends its process ends its own run alone, in a comparison and in the graph."""

import json
from pathlib import Path

import pytest
from support.fmu import CRASH, EXIT, faulty, unpacked

from ddct_bringup.programs.bringup import main as bringup
from ddct_bringup.programs.compare import main as compare

pytestmark = pytest.mark.usefixtures('folder')
SHORT = ('--scenario', 'thesis', '--set', 'duration_s=1')


def test_the_runs_of_other_controllers_are_kept(capsys: pytest.CaptureFixture[str]) -> None:
    out = Path('runs')
    controllers = ('--controllers', f'{faulty(2, EXIT)},pi')
    options = (*SHORT, '--headless', '--floors', 'none', '--out', str(out))
    assert compare([*controllers, *options]) == 1
    mine, pi = json.loads((out / 'scores.json').read_text())['runs']
    assert (mine['valid'], pi['valid']) == (False, True)
    assert 'pi.fmu: it ended with exit code 0 when update was called at' in mine['reason']
    assert (out / 'pi' / 'pi_0.mcap').is_file()
    lines = [line for line in capsys.readouterr().err.splitlines() if 'pi.fmu' in line]
    assert len(lines) == 1


@pytest.mark.parametrize(
    ('fault', 'end'), [(EXIT, 'ended with code 0'), (CRASH, 'was killed by SIGSEGV')]
)
def test_in_the_graph_it_ends_its_node_which_is_one_line_and_another_exit_code(
    capsys: pytest.CaptureFixture[str], fault: int, end: str
) -> None:
    assert bringup(['--controller', faulty(3, fault), *SHORT, '--out', 'runs']) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert f'node controller {end}' in line
    assert unpacked() == set()
