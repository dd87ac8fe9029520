# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The commands of the documentation, sorted by how a test runs them."""

import re
import shlex
import subprocess
from collections import Counter
from collections.abc import Sequence

from printed_commands import run_words

from support.documented import Block, blocks

NOT_RUN_HERE = {
    'make': 'would run this very test, or take its environment away; .ci/run and users run them',
    'tools/run': 'takes minutes, or a file of the past; an instrument is no part of the suite',
    'sudo': "needs Ubuntu with apt's ROS 2",
    'rosdep': "needs apt's ROS 2",
    'colcon': 'make setup has run it',
    '. /opt/ros': "needs apt's ROS 2",
    'git clone': 'is how one comes here',
    '.venv/bin/': 'would change the environment of the tests; tests/fmu, tests/conformance run it',
    'ddct check --new': 'takes a name that is free; tests/conformance runs it and what follows',
    'ddct compare --controllers pi,mine.yaml': 'needs an FMU; tests/fmu gives it one',
    'python -m pip': 'would change the environment of the tests',
    'jupyter lab': 'serves until Ctrl-C; tests/nightly/docs executes the notebooks',
    'python3 -m venv': 'tests/packaging/test_without_ros.py runs what pip would install',
    '. my-env': 'nothing is installed there by the tests',
    'ddct compare --mode realtime --controllers ls8 --live': (
        'waits for a viewer; tests/live gives it one'
    ),
    'ddct node clutch --ros-args -p qos_overrides': (
        'serves until Ctrl-C; tests/graph/test_qos_overrides.py stops it'
    ),
    'ddct campaign docs/examples/robustness': (
        'takes minutes; test_examples.py reads its specifications'
    ),
    'ddct benchmark mine': 'takes minutes; ddct_bringup/test/benchmark runs a small one',
    'python docs/examples/learn_launch.py': 'takes a minute; tests/nightly/docs learns for less',
    'ddct compare --controllers pi,ls8,learnt.py': 'needs what that writes',
    'ddct benchmark learnt': 'needs what that writes',
    'ddct identify --from drive.mf4': 'needs a log of a bus; tests/nightly/measured records one',
    'ddct verify results/mine': 'needs that benchmark',
    'ddct tune': 'takes minutes; ddct_bringup/test/tuning runs small ones',
    'ddct compare --controllers pi,tuned/pi/best.yaml': 'needs that tuning',
}
"""First words of commands and why no test runs them."""
OF_OWN_CAR = 'mine/data'
"""Part of the blocks whose lines tests/nightly/docs/test_ten_minutes.py runs in succession."""
SHELL_BLOCKS = [block for block in blocks() if block.is_shell and OF_OWN_CAR not in block.text]
SOURCE = '. install/setup.bash'
_TOOLS = ('cp ', 'cc ')
"""Commands of others that end by themselves."""
_OWN_PROCESS = ('&', 'realtime', 'ddct campaign')
"""Parts of commands that need processes of their own; a campaign's workers outlast a test."""
_WITH_SUBCOMMANDS = {'design', 'thesis', 'campaign', 'node'}
_NIGHTLY = (
    'ddct check',
    'ddct design h-infinity',
    'ddct thesis numbers',
    'ddct thesis figures',
    'ddct thesis studies',
    'ddct verify',
)
"""Commands that take more than a few seconds; other tests run parts of them."""
_LIST = re.compile(r'--controllers (\S+)|=([^\s:]+,\S+)|:(\d+)(?= |$)')
"""Parts of a command that repeat its work."""


def commands_of(block: Block) -> list[str]:
    """Return the lines of a block that tests run."""
    return [line for line in block.lines if not any(line.startswith(w) for w in NOT_RUN_HERE)]


def label(block: Block) -> str:
    """Return the name of the test of a block."""
    return f'{block.page}: {next(iter(commands_of(block)), block.lines[0])[:60]}'


def in_this_process(block: Block) -> bool:
    """Return whether all commands end by themselves, without a graph, and some are ours."""
    commands = [line for line in commands_of(block) if line != SOURCE]
    return any(line.startswith('ddct ') for line in commands) and all(
        line.startswith(('ddct ', *_TOOLS)) and not any(words in line for words in _OWN_PROCESS)
        for line in commands
    )


def in_order_of_work(found: Sequence[Block]) -> list[Block]:
    """Return blocks by the number of runs that their commands make, about."""
    return sorted(found, key=lambda block: sum(map(_runs, commands_of(block))))


def _runs(line: str) -> int:
    runs = 1
    for controllers, values, count in _LIST.findall(line):
        runs *= int(count) if count else len((controllers or values).split(','))
    return runs


def sample_of(found: Sequence[Block]) -> list[Block]:
    """
    Return blocks that together have each program that all have, with little work.

    Blocks with one of the commands of the nightly tier are left out.
    """
    shown = {block: {_program(line) for line in commands_of(block)} - {''} for block in found}
    short = [
        block
        for block in found
        if not any(line.startswith(_NIGHTLY) for line in commands_of(block))
    ]
    times = Counter(each for block in short for each in shown[block])
    sample = []
    for block in reversed(in_order_of_work(short)):
        if all(times[each] > 1 for each in shown[block]):
            times.subtract(shown[block])
        else:
            sample.append(block)
    return sample[::-1]


def _program(line: str) -> str:
    """Return the program of a line, with its subcommand; empty where it is none of ours."""
    words = shlex.split(line, comments=True)
    if words[0] != 'ddct':
        return ''
    return ' '.join(words[1:3] if words[1] in _WITH_SUBCOMMANDS else words[1:2])


def run_here(line: str) -> int:
    """
    Run one `ddct PROGRAM ARGUMENTS` in this process, or a tool, and return its exit code.

    A run of the graph takes place without it, which is faster; other tests run the real thing.
    """
    if line == SOURCE:
        return 0
    command = shlex.split(line, comments=True)
    if line.startswith(_TOOLS):
        return subprocess.run(command, check=False).returncode
    return run_words(command)
