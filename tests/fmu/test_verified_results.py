# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A result with an FMU carries it, and comes out again elsewhere."""

from pathlib import Path

import pytest
from support.fmu import controller_file

from ddct_bringup.programs.compare import main as compare
from ddct_bringup.programs.verify import main as verify


@pytest.mark.nightly
def test_a_result_with_an_fmu_is_verified_without_the_file_it_was_made_from(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = controller_file(3)
    given = ['--controllers', f'{file},pi', '--duration', '0.7', '--headless', '--out', 'runs']
    assert compare(given) == 0
    Path('pi.fmu').unlink()
    Path(file).unlink()
    moved = (folder / 'runs').rename(folder / 'moved')
    capfd.readouterr()
    assert verify([str(moved)]) == 0
    assert capfd.readouterr().out.endswith(' was made again, with equal bits.\n')
