# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Documented commands that need a shell: graphs by hand, sourcing, compiling."""

import os
import shutil
import stat
import subprocess
from pathlib import Path

import pytest
from documented_commands import NOT_RUN_HERE, SHELL_BLOCKS, commands_of, in_this_process, label
from support.documented import Block

pytestmark = pytest.mark.slow

WITHIN_S = 240.0
TOO_BUSY = 'steps held a torque for want of a reply'
"""What `bringup` says of a real-time run that does not count."""
BLOCKS = [block for block in SHELL_BLOCKS if not in_this_process(block)]

ROS2 = """\
#!{shell}
[ "$1 $2 $3" = 'run my_actuator my_actuator' ] || exit 2
shift 3
exec ddct actuator "$@"
"""


@pytest.fixture
def environment(workplace: Path, install: Path) -> dict[str, str]:
    """Return the environment of a shell with `ddct`, and a `ros2` for the foreign node."""
    ros2 = workplace / 'bin' / 'ros2'
    ros2.parent.mkdir()
    ros2.write_text(ROS2.format(shell=shutil.which('bash')))
    ros2.chmod(ros2.stat().st_mode | stat.S_IXUSR)
    path = f'{ros2.parent}:{install}/ddct_bringup/bin:{os.environ["PATH"]}'
    return {**os.environ, 'PATH': path}


@pytest.mark.parametrize('block', BLOCKS, ids=label)
def test_commands_run(block: Block, workplace: Path, environment: dict[str, str]) -> None:
    commands = commands_of(block)
    if not commands:
        pytest.skip(
            next(why for words, why in NOT_RUN_HERE.items() if block.text.startswith(words))
        )
    # Background nodes end with the script.
    script = '\n'.join(
        ['set -e', "trap 'kill $(jobs -p) 2>/dev/null || true; wait' EXIT", *commands]
    )
    done = subprocess.run(
        [shutil.which('bash') or 'bash', '-c', script],
        cwd=workplace,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    if 'realtime' in script and TOO_BUSY in done.stderr:
        pytest.skip('too busy for real time, as the program says: exit code 1')
    assert done.returncode == 0, f'{script}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}'
