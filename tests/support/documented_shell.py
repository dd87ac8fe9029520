# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Documented commands in a shell, for those that need one: graphs by hand, several processes."""

import os
import shutil
import stat
import subprocess
from collections.abc import Sequence
from pathlib import Path

from waiting import WITHIN_S

from support.documented import Block
from support.documented_commands import commands_of

MISSED = 'steps held a torque for want of a reply'
"""Reason of a run in real time that the busy machine kept from being valid."""
ROS2 = """\
#!{shell}
[ "$1 $2 $3" = 'run my_actuator my_actuator' ] || exit 2
shift 3
exec ddct node actuator "$@"
"""


def shell_environment(workplace: Path, install: Path) -> dict[str, str]:
    """Return the environment of a shell with `ddct`, and a `ros2` for the foreign node."""
    ros2 = workplace / 'bin' / 'ros2'
    ros2.parent.mkdir()
    ros2.write_text(ROS2.format(shell=shutil.which('bash')))
    ros2.chmod(ros2.stat().st_mode | stat.S_IXUSR)
    path = f'{ros2.parent}:{install}/ddct_bringup/bin:{os.environ["PATH"]}'
    return {**os.environ, 'PATH': path}


def run_block(block: Block, workplace: Path, environment: dict[str, str]) -> None:
    """Run the commands of a block in one shell, whose background nodes end with it."""
    run_lines(commands_of(block), workplace, environment)


def run_lines(commands: Sequence[str], workplace: Path, environment: dict[str, str]) -> None:
    """
    Run commands in one shell, whose background nodes end with it.

    On a busy machine a run in real time may miss too many steps, which ends the script there.
    """
    lines = ['set -e', "trap 'kill $(jobs -p) 2>/dev/null || true; wait' EXIT"]
    script = '\n'.join([*lines, *commands])
    done = subprocess.run(
        [shutil.which('bash') or 'bash', '-c', script],
        cwd=workplace,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=3 * WITHIN_S,
        check=False,
    )
    if '--mode realtime' in script and MISSED in done.stdout:
        return
    assert done.returncode == 0, f'{script}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}'
