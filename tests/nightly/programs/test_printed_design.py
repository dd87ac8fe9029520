# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The command that a design prints runs the designed controller."""

from pathlib import Path

import pytest
from printed_commands import printed_commands, run_printed, run_words


def test_the_printed_command_runs_a_design(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "the driver's own"
    place.mkdir()
    monkeypatch.chdir(place)
    design = 'ddct design loop-shaping --rise-time 0.3 --overshoot 10 --name quick --out'
    assert run_words([*design.split(), 'my designs']) == 0
    (command,) = printed_commands(capsys.readouterr().out)
    assert run_printed(command) == 0
    assert list(place.glob('runs/quick/*/*.mcap'))
