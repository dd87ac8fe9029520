# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Clock for the driveline in real time with which a busy machine misses no step."""

import sys
import time

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.ticks.realtime_owner import RealtimeOwner
from support.in_process_graph import InProcessGraph


class PatientClock:
    """
    Clock whose next step is due only once every reply to the last tick has arrived.

    So a run misses nothing, however slow the machine is. From `release`, or from a step, on it
    follows the wall clock.
    """

    def __init__(self, owner: RealtimeOwner, until_step: int = sys.maxsize) -> None:
        """Replace the clock of `owner`, before its run begins."""
        self._owner = owner
        self._until_step = until_step
        self._offset: float | None = None
        self._not_awaited: dict[str, int] = {}
        owner._clock = self

    def __call__(self) -> float:
        """Return the time in s."""
        if self._offset is None and self._owner.step >= self._until_step:
            self.release()
        return self._patient() if self._offset is None else time.monotonic() + self._offset

    def _patient(self) -> float:
        started, owner = self._owner._started_at, self._owner
        if started is None or owner.step == owner._plan.steps:
            return time.monotonic()
        missing = [
            topic for topic in owner.missing() if owner.step >= self._not_awaited.get(topic, 0)
        ]
        return started + (owner.step + (0.5 if missing else 1.5)) * PERIOD_S

    def go_on_without(self, topic: str, until_step: int = sys.maxsize) -> None:
        """Stop waiting for the replies on `topic` to ticks before `until_step`."""
        self._not_awaited[topic] = until_step

    def release(self) -> None:
        """Follow the wall clock from now on."""
        self._offset = self._patient() - time.monotonic()


def realtime_owner(graph: InProcessGraph) -> RealtimeOwner:
    """Return the owner of time of a graph in real time."""
    owner = graph.driveline.owner
    assert isinstance(owner, RealtimeOwner)
    return owner
