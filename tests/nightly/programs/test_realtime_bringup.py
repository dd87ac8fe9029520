# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`bringup` in real time, in one process."""

from pathlib import Path

import pytest

from ddct_bringup.programs import bringup


@pytest.mark.parametrize('scenario', ['thesis_sticking', 'upshift'])
def test_a_real_time_run_in_one_process_prints_its_folder_alone(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, scenario: str
) -> None:
    out = tmp_path / 'runs'
    arguments = ['--controller', 'pi', '--scenario', scenario]
    arguments += ['--duration', '0.8', '--single-process', '--mode', 'realtime', '--out', str(out)]
    code = bringup.main(arguments)
    printed = capfd.readouterr()
    assert ' (single-process)\n' in printed.err
    # On a busy machine too many steps are missed; the folder is then that of an invalid run.
    assert printed.out == (f'{out / "pi"}\n' if code == 0 else '')
