# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Workers of a campaign in the process of the test, which fail at chosen shards."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from typing import Any
from unittest import mock

from ddct_bringup.campaign import conduct


class InThisProcess(Executor):
    """Executor that computes at once; `breaks` returns the error of a shard by its first index."""

    def __init__(self, breaks: Callable[[int], Exception | None]) -> None:
        self._breaks = breaks
        self.computed: list[int] = []

    def submit(self, fn: Any, /, *arguments: Any, **_: Any) -> Future[Any]:
        future: Future[Any] = Future()
        first = arguments[0].first
        self.computed.append(first)
        if error := self._breaks(first):
            future.set_exception(error)
        else:
            future.set_result(fn(*arguments))
        return future


class OneByOne:
    """Workers that are executors in this process."""

    def __init__(self, breaks: Callable[[int], Exception | None] = lambda first: None) -> None:
        self.count = 2
        self.executors: list[InThisProcess] = []
        self._breaks = breaks

    def executor(self) -> Executor:
        self.executors.append(InThisProcess(self._breaks))
        return self.executors[-1]

    def require_alive(self) -> None:
        pass

    @property
    def computed(self) -> list[int]:
        return [first for executor in self.executors for first in executor.computed]


@contextmanager
def in_this_process(workers: OneByOne | None = None) -> Iterator[OneByOne]:
    """Let campaigns be computed by these workers."""
    chosen = workers or OneByOne()

    @contextmanager
    def workers_of(*_: Any) -> Iterator[OneByOne]:
        yield chosen

    with mock.patch.object(conduct, 'workers_of', workers_of):
        yield chosen
