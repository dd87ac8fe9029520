# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Processor time of writing and of reading a bag, in a workspace of this or of another commit."""

import tempfile
from pathlib import Path

from bench.workspaces import bringup, run

READ, WRITE = 'read', 'write'
_PROGRAM = """\
import sys, time
from pathlib import Path
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.trajectory_bag import write_trajectory

source, scratch = map(Path, sys.argv[1:3])
made = read_bag(source)

def write(number):
    folder = scratch / str(number)
    write_trajectory(made.trajectory, folder, 'pi', made.custom_data, made.run_info)

work = {'read': lambda _: read_bag(source), 'write': write}[sys.argv[3]]
costs = []
for number in range(6):
    started = time.process_time()
    work(number)
    costs.append(time.process_time() - started)
print(min(costs[1:]))
"""


def bag_s(workspace: Path, what: str, *options: str) -> float:
    """
    Return the processor time in s of reading or of writing the bag of a headless run of 20 s.

    It is the least of five; what is imported and found out once does not count. `options` are
    those of `bringup`.
    """
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        length = ('--set', 'duration_s=20')
        command = ('--controller', 'pi', '--headless', *length, *options)
        run(workspace, bringup(workspace), *command, '--out', folder / 'runs')
        python = workspace / '.venv' / 'bin' / 'python'
        shown = run(workspace, python, '-c', _PROGRAM, folder / 'runs' / 'pi', folder, what)
    return float(shown)
