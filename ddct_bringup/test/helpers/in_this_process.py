# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Workers of a campaign in the process of the test, which fail at chosen shards."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future
from contextlib import contextmanager
from typing import Any
from unittest import mock

from ddct_bringup.campaign import conduct
from ddct_bringup.campaign.shards import CampaignRun
from ddct_bringup.many_runs.local_workers import Ended, Submit
from ddct_bringup.many_runs.work import Work


class OneByOne:
    """Workers that compute at once; `breaks` returns the error of a shard by its first run."""

    count, ahead = 2, 1

    def __init__(self, breaks: Callable[[int], Exception | None] = lambda first: None) -> None:
        self.computed: list[int] = []
        self.begun = 0
        self._breaks = breaks

    def begin(self, work: Work[Any, Any]) -> Submit:
        self.begun += 1

        def submit(items: Sequence[CampaignRun]) -> Future[Any]:
            future: Future[Any] = Future()
            first = items[0].run
            self.computed.append(first)
            if error := self._breaks(first):
                future.set_exception(error)
            else:
                future.set_result(work.of_block(items))
            return future

        return submit

    def alone(self) -> 'OneByOne':
        return self

    def ended(self, error: BaseException) -> Ended | None:
        if isinstance(error, BrokenExecutor):
            return Ended('its process was killed (SIGKILL)', by_itself=False)
        return None

    def require_alive(self) -> None:
        pass

    def close(self) -> None:
        pass


@contextmanager
def in_this_process(workers: OneByOne | None = None) -> Iterator[OneByOne]:
    """Let campaigns be computed by these workers."""
    chosen = workers or OneByOne()
    with mock.patch.object(conduct, 'workers_of', lambda *_: chosen):
        yield chosen
