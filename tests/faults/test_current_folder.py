# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files in the user's current folder are not imported by the nodes."""

import sys
from pathlib import Path

from support.processes import Programs


def test_a_file_that_is_called_like_a_module_hides_nothing_from_the_nodes(
    programs: Programs, tmp_path: Path
) -> None:
    for name in ('numpy.py', 'rclpy.py', 'ddct_plant.py'):
        (tmp_path / name).write_text('raise SystemExit("mine")\n', encoding='utf-8')
    run = programs.start(
        [
            *(sys.executable, '-P', '-m', 'ddct_bringup.programs.bringup'),
            *('--duration', '0.7', '--out', 'runs'),
        ],
        cwd=tmp_path,
    )
    assert run.wait() == 0, run.errors()
    assert (tmp_path / 'runs' / 'pi' / 'pi_0.mcap').is_file()
