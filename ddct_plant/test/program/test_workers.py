# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Work shared among processes has the results of one process; a killed worker is reported."""

import multiprocessing
import os
import signal
import threading
import time
from contextlib import closing
from multiprocessing.process import BaseProcess

import pytest

from ddct_plant.base.errors import DdctError
from ddct_plant.program.workers import WorkerPool, in_processes


@pytest.mark.process
def test_results_come_in_order_whatever_the_number_of_workers():
    for workers in (1, 2, 3):
        with in_processes(lambda index: index**2, 40, workers) as results:
            assert list(results) == [index**2 for index in range(40)]


@pytest.mark.process
def test_work_is_done_in_other_processes():
    with in_processes(lambda _: os.getpid(), 4, 2) as results:
        assert os.getpid() not in set(results)


@pytest.mark.process
def test_a_killed_worker_is_reported_in_a_line():
    with (
        pytest.raises(DdctError, match='killed'),
        in_processes(lambda _: os.kill(os.getpid(), signal.SIGKILL), 2, 2) as results,
    ):
        list(results)


@pytest.mark.process
def test_a_new_pool_ends_the_processes_of_the_former_one():
    with closing(WorkerPool(1)) as pool:
        former = pool.executor()
        former.submit(os.getpid).result()
        (worker,) = multiprocessing.active_children()
        pool.executor()
        assert not worker.is_alive()
        assert not multiprocessing.active_children()


@pytest.mark.process
def test_a_pool_that_is_closed_leaves_no_thread_for_pythons_exit():
    before = {*threading.enumerate()}
    # More than once: the pool's own thread may end while its processes are awaited.
    for _ in range(4):
        with in_processes(lambda _: time.sleep(60.0), 4, 2):
            pass
        assert {*threading.enumerate()} <= before


@pytest.mark.process
def test_ctrl_c_while_workers_are_ended_leaves_none(monkeypatch):
    kill = BaseProcess.kill

    def interrupted(process):
        os.kill(os.getpid(), signal.SIGINT)
        kill(process)

    # More than once: two threads wait for the same processes, and either may be the first.
    for _ in range(4):
        with (
            monkeypatch.context() as patch,
            pytest.raises(KeyboardInterrupt),
            in_processes(lambda _: time.sleep(60.0), 4, 2),
        ):
            patch.setattr(BaseProcess, 'kill', interrupted)
        assert not multiprocessing.active_children()


@pytest.mark.process
def test_a_worker_whose_start_was_interrupted_is_ended_too():
    with in_processes(lambda _: time.sleep(60.0), 4, 2):
        # The pool does not know it: Ctrl-C came between its fork and the entry in the pool's list.
        multiprocessing.get_context('fork').Process(target=time.sleep, args=(60.0,)).start()
        assert len(multiprocessing.active_children()) == 3
    assert not multiprocessing.active_children()
