# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The programs as colcon installs them: `install/<package>/lib/<package>/<program>`."""

from pathlib import Path

import pytest
from support.installed import installed
from support.processes import Programs

from ddct_plant.program.command_line import scripts

PROGRAMS = sorted((point.module.partition('.')[0], name) for name, point in scripts().items())


@pytest.mark.parametrize(('package', 'program'), PROGRAMS, ids=[name for _, name in PROGRAMS])
def test_every_program_is_installed_in_the_folder_of_ros2_run(package: str, program: str) -> None:
    assert Path(installed(package, program)).is_file()


def test_the_installed_bringup_runs_and_scores(programs: Programs, tmp_path: Path) -> None:
    out = str(tmp_path / 'runs')
    options = ['--single-process', '--duration', '0.7', '--out', out]
    bringup = programs.start([installed('ddct_bringup', 'bringup'), *options])
    assert bringup.wait() == 0, bringup.errors()
    score = programs.start([installed('ddct_bringup', 'score'), out])
    assert score.wait() == 0, score.errors()
    assert 'pi' in score.output()
