# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` repeats a run of the graph headless; of a run in real time it says that it cannot."""

import json
from pathlib import Path

import pytest

from ddct_bringup.programs import bringup, verify


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
