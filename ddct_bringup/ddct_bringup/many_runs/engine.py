# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The engine: blocks of work go to workers, and each comes back once.

    with engine_of(work, workers=4) as engine:
        for done in engine.done(blocks_of(items, block_size(len(items)))):
            ...

When a worker dies, the blocks that it may have died of are computed one after the other, in a
process of their own. One that ends this too is halved, down to the item that ends it.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from itertools import islice
from typing import Generic, TypeVar

from ddct_bringup.many_runs.blocks import block_size, blocks_of
from ddct_bringup.many_runs.dask_workers import DaskWorkers
from ddct_bringup.many_runs.local_workers import (
    Ended,
    LocalWorkers,
    ThisProcess,
    is_worker,
    worker_count,
)
from ddct_bringup.many_runs.work import Each, Item, Result, Work
from ddct_plant.base.errors import DdctError

_MOST_DEATHS = 3
"""Largest number of items in succession whose process was killed, before the work ends."""
_POLL_S = 0.2
"""Time in s between two checks of signals and workers."""
Workers = LocalWorkers | ThisProcess | DaskWorkers
"""Those who do the work, and their number."""
Value = TypeVar('Value')


def _never() -> bool:
    return False


@dataclass(frozen=True)
class Done(Generic[Item, Result]):
    """A block with its result."""

    place: int
    """Number of the block, in the order in which they were given."""
    items: Sequence[Item]
    result: Result


@dataclass
class WorkEngine(Generic[Item, Result]):
    """Does work block by block on workers."""

    work: Work[Item, Result]
    workers: Workers
    stopped: Callable[[], bool] = _never
    """Whether the user has stopped the program."""
    advice: str = 'start again'
    """What to do after an interruption, for messages."""
    _killed: int = field(default=0, init=False)
    """Number of items in succession whose process was killed."""

    def done(self, blocks: Iterable[Sequence[Item]]) -> Iterator[Done[Item, Result]]:
        """
        Yield each block when it is done, in any order.

        Raise the exception of the work, of several that of the first block; DdctError where
        workers die one after the other; KeyboardInterrupt when the user has stopped the program.
        """
        waiting = enumerate(blocks)
        running: dict[Future[Result], tuple[int, Sequence[Item]]] = {}
        ended: dict[int, Sequence[Item]] = {}
        # Where the last processes were killed, none of these counts until others are not.
        apart: list[Done[Item, Result]] = []
        while True:
            if ended and not running:
                apart += self._done_apart(ended)
                ended = {}
            if not self._killed:
                yield from apart
                apart = []
            if not ended:
                free = max(self.workers.ahead * self.workers.count - len(running), 0)
                submit = self.workers.begin(self.work)
                for place, items in islice(waiting, free):
                    try:
                        running[submit(items)] = place, items
                    except BrokenExecutor:  # a worker has died since
                        ended[place] = items
                        break
            if not running and not ended:
                yield from apart
                return
            for future in sorted(self._finished(running), key=lambda each: running[each][0]):
                place, items = running.pop(future)
                try:
                    has_ended = self._ended(self.workers, future, items)
                except Exception:
                    self._require_results(running, place)
                    raise
                if has_ended:
                    ended[place] = items
                else:
                    self._killed = 0
                    yield Done(place, items, future.result())

    def in_order(self, blocks: Iterable[Sequence[Item]]) -> Iterator[Result]:
        """Yield the result of each block, in the order of the blocks; raise as `done`."""
        early: dict[int, Result] = {}
        place = 0
        for done in self.done(blocks):
            early[done.place] = done.result
            while place in early:
                yield early.pop(place)
                place += 1

    def _done_apart(self, blocks: dict[int, Sequence[Item]]) -> list[Done[Item, Result]]:
        """Return blocks of which one has ended its process, each computed by a process alone."""
        alone = self.workers.alone()
        try:
            return [
                Done(place, items, self._apart(items, alone))
                for place, items in sorted(blocks.items())
            ]
        finally:
            if alone is not self.workers:
                alone.close()

    def _apart(self, items: Sequence[Item], alone: Workers) -> Result:
        """Return the result of a block; items that end their process have the reason as result."""
        future = alone.begin(self.work)(items)
        while not self._finished([future]):
            pass
        ended = self._ended(alone, future, items)
        if ended is None:
            self._killed = 0
            return future.result()
        if not ended.by_itself and (len(items) == 1 or not ended.how):
            self._killed += 1
            if self._killed == _MOST_DEATHS:
                raise DdctError(
                    f'workers died {_MOST_DEATHS} times one after the other: free some memory or '
                    f'take fewer of them; {self.advice}'
                )
        if not ended.how:
            return self._apart(items, alone)
        if len(items) == 1:
            return self.work.without_result(items[0], ended.how)
        half = len(items) // 2
        return self.work.joined(
            [self._apart(part, alone) for part in (items[:half], items[half:])]
        )

    def _ended(
        self, workers: Workers, future: 'Future[Result]', items: Sequence[Item]
    ) -> Ended | None:
        """Return how the process of a block ended, None with a result; raise an error of it."""
        error = CancelledError() if future.cancelled() else future.exception()
        if error is None:
            return None
        if ended := workers.ended(error):
            self.workers.require_alive()
            return ended
        raise self.work.error(items, error) if isinstance(error, Exception) else error

    def _require_results(
        self, running: Mapping['Future[Result]', tuple[int, Sequence[Item]]], place: int
    ) -> None:
        """
        Wait for the blocks before `place`, and raise the error of the first that has one.

        Blocks begin in their order, so that an error does not depend on which worker was faster.
        """
        before = {future: block for future, block in running.items() if block[0] < place}
        while waiting := [future for future in before if not future.done()]:
            self._finished(waiting)
        for future, (_, items) in sorted(before.items(), key=lambda each: each[1][0]):
            self._ended(self.workers, future, items)

    def _finished(self, futures: Iterable[Future[Result]]) -> set[Future[Result]]:
        """Return the finished ones of futures, none after `_POLL_S`."""
        finished = wait(futures, _POLL_S, FIRST_COMPLETED).done
        if self.stopped():
            raise KeyboardInterrupt(f'interrupted; {self.advice}')
        if not finished:
            self.workers.require_alive()
        return finished


def workers_of(count: int | None, scheduler: str | None = None) -> Workers:
    """Return the workers of a scheduler address, or those here; a worker has itself alone."""
    if scheduler:
        return DaskWorkers(scheduler)
    return ThisProcess() if is_worker() else LocalWorkers(count)


@contextmanager
def engine_of(
    work: Work[Item, Result],
    workers: int | None = None,
    stopped: Callable[[], bool] = _never,
) -> Iterator[WorkEngine[Item, Result]]:
    """Yield an engine with processes of this machine, by default one per core, and end them."""
    with closing(workers_of(workers)) as chosen:
        yield WorkEngine(work, chosen, stopped)


def each_result(
    function: Callable[[Item], Value], items: Sequence[Item], workers: int | None = None
) -> Iterator[Value]:
    """
    Yield the result of a function of each item, in their order, computed as they are taken.

    It is computed by `workers` processes, by default one per core; 1 means this process. The
    function may be any; results are pickled. Raise its exception, and DdctError for a process that
    is killed.
    """
    count = min(worker_count(workers), len(items))
    if count < 2 or is_worker():
        yield from map(function, items)
        return
    with engine_of(Each(function), count) as engine:
        for part in engine.in_order(blocks_of(items, block_size(len(items)))):
            yield from part


def results_of(
    function: Callable[[Item], Value], items: Sequence[Item], workers: int | None = None
) -> list[Value]:
    """Return the result of a function of each item, as `each_result` yields them."""
    return [*each_result(function, items, workers)]
