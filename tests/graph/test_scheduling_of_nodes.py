# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The kernel treats the nodes of a real-time run as its options ask, and only there."""

import os
import signal
from contextlib import suppress
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.processes import Programs, processes_left
from support.waiting import wait_until

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_bringup.programs import bringup
from ddct_plant.base.errors import DdctError
from ddct_plant.program.scheduling import Scheduling

NODES = {f'{node.name}_node:': node.name for node in GRAPH_NODES}
CORE = min(os.sched_getaffinity(0))
PRIORITY = 3


def scheduling_of(pid: int) -> tuple[set[int], int]:
    return os.sched_getaffinity(pid), os.sched_getparam(pid).sched_priority


def scheduling_of_nodes() -> dict[str, tuple[set[int], int]]:
    found = {}
    for pid, command in processes_left().items():
        for node in NODES.keys() & command.split():
            # A process may end during the scan.
            with suppress(ProcessLookupError):
                found[NODES[node]] = scheduling_of(pid)
    return found


def test_the_nodes_have_cores_and_priority_and_the_recorder_has_one_priority_less(
    programs: Programs, tmp_path: Path
) -> None:
    priority = PRIORITY
    try:
        Scheduling(realtime_priority=PRIORITY).require_permitted()
    except DdctError:
        priority = 0
    options = ['--cpus', str(CORE), '--realtime-priority', str(priority)]
    run = programs.fork(
        *('ddct_bringup.programs.bringup', '--mode', 'realtime', *options),
        *('--duration', '600', '--out', str(tmp_path / 'run')),
    )
    wanted = {name: ({CORE}, priority) for name in NODES.values()}
    wanted['recorder'] = ({CORE}, max(priority - 1, 0))
    wait_until(lambda: scheduling_of_nodes() == wanted, f'{wanted}')
    run.send(signal.SIGINT)
    assert run.wait() == 130


BAD = {
    'lock-step': (['--realtime-priority', '3'], ['realtime_priority', 'lock-step']),
    'headless': (['--headless', '--lock-memory'], ['lock_memory', 'lock-step']),
    'no such core': (['--mode', 'realtime', '--cpus', '9998'], ['cpus', '9998']),
    'no core': (['--mode', 'realtime', '--cpus', 'all'], ['cpus', "'all'"]),
    'priority': (['--mode', 'realtime', '--realtime-priority', '99'], ['realtime_priority', '98']),
}


@pytest.mark.parametrize(('options', 'words'), BAD.values(), ids=BAD)
def test_what_cannot_be_given_is_named_and_nothing_is_written(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, options: list[str], words: list[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main([*options, '--out', str(out)]) == 1
    assert_one_line(capfd.readouterr().err, 'ddct bringup', *words)
    assert not out.exists()
