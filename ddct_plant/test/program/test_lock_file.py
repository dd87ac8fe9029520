# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A lock file belongs to one process: its forks do not have it."""

import multiprocessing
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from ddct_plant.program.lock_file import LockFile


def _wait_for_end(connection: Connection) -> None:
    connection.send('begun')
    connection.recv()


@pytest.mark.process
def test_a_fork_that_goes_on_does_not_keep_the_lock_of_its_parent(tmp_path: Path) -> None:
    file = tmp_path / 'lock'
    ours, theirs = multiprocessing.Pipe()
    context = multiprocessing.get_context('fork')
    lock = LockFile(file)
    fork = context.Process(target=_wait_for_end, args=(theirs,))
    fork.start()
    assert ours.recv() == 'begun'
    with pytest.raises(BlockingIOError):
        LockFile(file)
    lock.leave()  # as the kernel does at the end of a killed process
    try:
        with LockFile(file):
            assert fork.is_alive()
    finally:
        ours.send('end')
        fork.join(60.0)
    assert not file.exists()
