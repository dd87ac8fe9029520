# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Work has the same results on any workers, and what ends a process is found."""

import itertools
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Sequence
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import pytest
from samples import sampled

from ddct_bringup.many_runs.blocks import block_size, blocks_of
from ddct_bringup.many_runs.engine import WorkEngine, engine_of, results_of
from ddct_bringup.many_runs.local_workers import LocalWorkers, ThisProcess, is_worker
from ddct_bringup.many_runs.work import Each
from ddct_plant.base.errors import DdctError, ParameterError

pytestmark = pytest.mark.process
ITEMS = range(40)


class Reasons(Each[int, Any]):
    """A function of numbers; one that ends its process has the reason as result."""

    def without_result(self, item: int, why: str) -> list[Any]:
        return [f'{item}: {why}']


def values(function: Callable[[int], Any], size: int, workers: int = 2) -> list[Any]:
    """Return the results of `ITEMS` in blocks of a size."""
    with engine_of(Reasons(function), workers) as engine:
        return [value for part in engine.in_order(blocks_of(ITEMS, size)) for value in part]


@pytest.mark.parametrize(
    ('size', 'workers'), sampled(itertools.product([40, 7, 1], [1, 3, 2]), every=4)
)
def test_results_come_in_order_whatever_the_workers_and_the_blocks(
    workers: int, size: int
) -> None:
    squares = [item**2 for item in ITEMS]
    assert values(lambda item: item**2, size, workers) == squares
    assert results_of(lambda item: item**2, ITEMS, workers) == squares
    here = WorkEngine(Reasons(lambda item: item**2), ThisProcess())
    assert [value for part in here.in_order(blocks_of(ITEMS, size)) for value in part] == squares


def test_work_is_done_in_other_processes_and_in_a_worker_in_itself() -> None:
    assert os.getpid() not in set(results_of(lambda _: os.getpid(), range(4), 2))
    within = results_of(
        lambda _: (is_worker(), {*results_of(lambda _: os.getpid(), range(4))} == {os.getpid()}),
        range(2),
        2,
    )
    assert within == [(True, True)] * 2
    assert not is_worker()


def test_fewer_than_one_worker_is_refused() -> None:
    with pytest.raises(ParameterError, match='workers is 0: give 1 or more'):
        results_of(abs, ITEMS, 0)


def _ends_at_some(item: int) -> int:
    if item == 7:
        os.kill(os.getpid(), signal.SIGSEGV)
    if item == 8:
        os._exit(3)
    if item == 21:
        os.kill(os.getpid(), signal.SIGKILL)
    if item == 30:
        os.kill(os.getpid(), signal.SIGTERM)
    return item


@pytest.mark.parametrize(
    ('size', 'workers'), sampled(itertools.product([16, 40, 1], [2, 1]), every=3)
)
def test_an_item_that_ends_its_process_has_the_reason_and_all_others_their_results(
    size: int, workers: int
) -> None:
    expected: list[Any] = [*ITEMS]
    expected[7] = '7: its process crashed (SIGSEGV)'
    expected[8] = '8: its process ended with exit code 3'
    expected[21] = '21: its process was killed (SIGKILL)'
    expected[30] = '30: its process was killed (SIGTERM)'
    assert values(_ends_at_some, size, workers) == expected


def test_a_process_that_is_killed_once_costs_only_time(tmp_path: Path) -> None:
    once = tmp_path / 'once'

    def killed_once(item: int) -> int:
        if item == 5 and not once.exists():
            once.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return item

    assert values(killed_once, 4) == [*ITEMS]


def test_processes_that_are_always_killed_end_the_work_with_a_line() -> None:
    with pytest.raises(DdctError, match='workers died 3 times one after the other: free some'):
        values(lambda _: os.kill(os.getpid(), signal.SIGKILL), 4)
    assert not multiprocessing.active_children()


def test_a_map_whose_process_is_killed_ends_with_a_line() -> None:
    with pytest.raises(DdctError, match=r'its process was killed \(SIGKILL\): free some memory'):
        results_of(lambda _: os.kill(os.getpid(), signal.SIGKILL), range(2), 2)


def test_an_exception_of_the_work_is_raised_as_it_is() -> None:
    with pytest.raises(ZeroDivisionError):
        results_of(lambda item: 1 / item, range(-4, 4), 2)
    assert not multiprocessing.active_children()


def test_of_several_exceptions_that_of_the_first_block_is_raised_whichever_comes_first(
    tmp_path: Path,
) -> None:
    failed = tmp_path / 'failed'

    def work(item: int) -> None:
        if item:
            failed.touch()
        while not failed.exists():
            time.sleep(0.01)
        time.sleep(0.0 if item else 0.3)
        raise ValueError(f'item {item}')

    with pytest.raises(ValueError, match='^item 0$'):
        values(work, 1)
    assert not multiprocessing.active_children()


def test_blocks_are_handed_over_as_they_are_needed() -> None:
    computed: list[int] = []

    def counted(item: int) -> int:
        computed.append(item)
        return item

    engine: WorkEngine[int, list[int]] = WorkEngine(Each(counted), ThisProcess())
    assert next(engine.in_order(blocks_of(ITEMS, 2))) == [0, 1]
    assert computed == [0, 1]


def test_a_stop_ends_the_work_and_leaves_no_process() -> None:
    looks = iter([False, True])
    sleep: Each[int, None] = Each(lambda _: time.sleep(60.0))
    with (
        engine_of(sleep, 2, lambda: next(looks)) as engine,
        pytest.raises(KeyboardInterrupt, match='interrupted; start again'),
    ):
        list(engine.done(blocks_of(ITEMS, 1)))
    assert not multiprocessing.active_children()


def sleeping(workers: LocalWorkers) -> None:
    """Let all workers sleep."""
    submit = workers.begin(Each(lambda _: time.sleep(60.0)))
    for item in range(4):
        submit([item])


def test_workers_with_other_work_are_other_processes() -> None:
    workers = LocalWorkers(1)
    try:
        workers.begin(Each(lambda _: os.getpid()))([0]).result()
        (worker,) = multiprocessing.active_children()
        workers.begin(Each(abs))
        assert not worker.is_alive()
        assert not multiprocessing.active_children()
    finally:
        workers.close()


def test_closed_workers_leave_no_thread_for_pythons_exit() -> None:
    before = {*threading.enumerate()}
    # More than once: the pool's own thread may end while its processes are awaited.
    for _ in range(4):
        workers = LocalWorkers(2)
        sleeping(workers)
        workers.close()
        assert {*threading.enumerate()} <= before


def test_ctrl_c_while_workers_are_ended_leaves_none(monkeypatch: pytest.MonkeyPatch) -> None:
    kill = BaseProcess.kill

    def interrupted(process: BaseProcess) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        kill(process)

    # More than once: two threads wait for the same processes, and either may be the first.
    for _ in range(4):
        workers = LocalWorkers(2)
        sleeping(workers)
        with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
            patch.setattr(BaseProcess, 'kill', interrupted)
            workers.close()
        assert not multiprocessing.active_children()


def test_a_worker_whose_start_was_interrupted_is_ended_too() -> None:
    workers = LocalWorkers(2)
    sleeping(workers)
    # The pool does not know it: Ctrl-C came between its fork and the entry in the pool's list.
    multiprocessing.get_context('fork').Process(target=time.sleep, args=(60.0,)).start()
    assert len(multiprocessing.active_children()) == 3
    workers.close()
    assert not multiprocessing.active_children()


@pytest.mark.parametrize(
    ('items', 'alone', 'together'),
    [
        (1, 1, 1),
        (8, 1, 8),
        (165, 4, 165),
        (600, 12, 256),
        (2000, 40, 500),
        (4000, 80, 1000),
        (100_000, 2000, 2000),
        (10_000_000, 2000, 2000),
    ],
)
def test_blocks_are_fewer_where_items_are_computed_together(
    items: int, alone: int, together: int
) -> None:
    assert (block_size(items), block_size(items, together=True)) == (alone, together)
    blocks: Sequence[Sequence[int]] = [*blocks_of(range(items), together)]
    assert sum(map(len, blocks)) == items
    assert {len(each) for each in blocks[:-1]} <= {together}
