# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a case leaves behind: processes of its own, and shared memory without an owner."""

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager

from support.processes import TEST_ID, processes_left
from support.shared_memory import has_owner, segments_of
from waiting import wait_until

from ddct_plant.graph.domain import own_domain
from ddct_plant.graph.half_made_ports import SHARED_MEMORY

LEAVE_S = 25.0
"""Time in s that processes have to end by themselves: a node ends 10 s after its program."""


class Leftovers:
    """Segments of the processes of one case, and what of it is still there after the case."""

    def __init__(self) -> None:
        self._segments: set[str] = set()

    def note(self, pid: int) -> None:
        """Note the shared memory of a process that may be killed."""
        self._segments |= {name for name in segments_of(pid) if 'port' not in name}

    def found(self) -> list[str]:
        """Return what is left of the case, once its processes have had time to end."""
        left = []
        try:
            wait_until(lambda: not processes_left(), 'the end of all processes', LEAVE_S)
        except AssertionError:
            left += [f'left: {command}' for command in processes_left().values()]
        there = {file.name for file in SHARED_MEMORY.iterdir()}
        orphans = [name for name in self._segments if name in there and not has_owner(name)]
        return [*left, *(f'left: /dev/shm/{name}' for name in orphans)]


@contextmanager
def isolated() -> Iterator[None]:
    """Give the case a domain of its own, and mark the processes that it starts."""
    before = {name: os.environ.get(name) for name in (TEST_ID, 'ROS_AUTOMATIC_DISCOVERY_RANGE')}
    os.environ[TEST_ID] = uuid.uuid4().hex
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    try:
        with own_domain():
            yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
