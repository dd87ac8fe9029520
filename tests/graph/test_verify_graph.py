# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` repeats a run of the graph headless; of a run in real time it says that it cannot."""

import json
from pathlib import Path

import pytest

from ddct_bringup.programs import bringup, compare, verify

FAILING = """\
from ddct_bringup.api import Command, Controller


class Mine(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        assert measurement.step < 65, 'no more'
        return Command(0.0)
"""


@pytest.mark.parametrize(
    ('mode', 'state', 'exit_code', 'words'),
    [
        ('lockstep', 'same_bits', 0, 'everything else was made again, with equal bits.'),
        ('realtime', 'not_repeated', 3, '(real time).'),
    ],
)
def test_a_run_of_the_graph_is_verified_in_its_mode(
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    mode: str,
    state: str,
    exit_code: int,
    words: str,
) -> None:
    out = str(tmp_path / 'runs')
    # A loaded machine may miss steps in real time, which leaves the run in its partial folder.
    arguments = ['--single-process', '--duration', '0.8', '--mode', mode]
    code = bringup.main([*arguments, '--out', out])
    assert code == 0 or mode == 'realtime'
    capfd.readouterr()
    assert verify.main([out, '--json', str(tmp_path / 'found.json')]) == exit_code
    assert capfd.readouterr().out.splitlines()[-1].endswith(words)
    (run,) = json.loads((tmp_path / 'found.json').read_text(encoding='utf-8'))['runs']
    assert run['state'] == state
    (bag,) = (tmp_path / 'runs').glob('pi*/*.mcap')
    bag.write_bytes(bag.read_bytes() + b'\0')
    assert verify.main([out]) == 1
    assert f'{bag}: altered' in capfd.readouterr().err


@pytest.mark.nightly
def test_a_compared_run_that_failed_in_the_graph_fails_again(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file, out = tmp_path / 'mine.py', tmp_path / 'runs'
    file.write_text(FAILING, encoding='utf-8')
    arguments = ['--single-process', '--duration', '0.7', '--floors', 'none']
    code = compare.main([*arguments, '--controllers', f'{file},pi', '--out', str(out)])
    assert code == 1
    assert list((out / 'Mine').glob('*.mcap')), 'the run leaves a bag until then'
    capfd.readouterr()
    assert verify.main([str(out), '--json', str(tmp_path / 'found.json')]) == 3
    last = capfd.readouterr().out.splitlines()[-1]
    assert 'Mine (it fails again for the same reason; its bag until then is not made' in last
    found = json.loads((tmp_path / 'found.json').read_text(encoding='utf-8'))
    states = {run['run']: run['state'] for run in found['runs']}
    assert states.pop('Mine') == 'not_repeated'
    assert set(states.values()) == {'same_bits'}
