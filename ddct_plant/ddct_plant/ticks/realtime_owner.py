# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The owner of time at 100 Hz on a steady clock; does not depend on ROS."""

from collections.abc import Callable, Sequence
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS, stamp_of_step, time_of_step
from ddct_plant.fail_safe.request_watch import FailSafe
from ddct_plant.ticks.tick_owner import Reply, Rows, TickOwner

RECORDER_PATIENCE_S = 2.0
"""Longest wait in s of a real-time run at t_N for the recorder, which may have missed a reply."""


class RealtimeOwner(TickOwner):
    """
    Step on a steady 10 ms grid with the replies to the previous tick, and count missing replies.

    At t_0 the owner waits for all replies as in lock-step, recorder included: the start barrier.
    At t_N it waits for the torques, which end the run, and up to `RECORDER_PATIENCE_S` for the
    recorder. In between a missing torque is held at its last value. When the clutch torque is
    missing for longer than its timeout, it runs to zero at the rate of the plan and later clutch
    torques are ignored: that is the safe state.
    """

    def __init__(
        self, *arguments: Any, on_started: Callable[[], object] = lambda: None, **options: Any
    ) -> None:
        """Accept the arguments of `TickOwner`; call `on_started` when the 10 ms grid begins."""
        super().__init__(*arguments, **options)
        self._on_started = on_started
        self.missed_replies = dict.fromkeys(self._plan.torques, 0)
        self.worst_lateness_s = 0.0
        self._held: dict[str, Reply] = {}
        self._silent_since: dict[str, int] = dict.fromkeys(self._plan.torques, 0)
        self._held_clutch: list[float] = []
        self._clutch = FailSafe(self._plan.fail_safe)
        self._started_at: float | None = None

    @property
    def safe(self) -> bool:
        """Whether the clutch torque has timed out and is on its way to zero."""
        return self._clutch.stopped

    def tick(self) -> None:
        """Integrate every step that is due by the wall clock."""
        if self._started_at is None:
            return
        while self.step < self.last_step:
            due = self._started_at + (self.step + 1) * PERIOD_S
            now = self._clock()
            if now < due:
                return
            self.worst_lateness_s = max(self.worst_lateness_s, now - due)
            self._take_step()

    def watch(self) -> None:
        """Check the timeouts of the first and the last tick; the ones between never wait."""
        if self._started_at is not None and self.step < self.last_step:
            return
        waited_s = self._clock() - self._opened_at
        recorder_alone = self.missing() == [self._plan.recorder]
        if self._started_at is not None and recorder_alone and waited_s > RECORDER_PATIENCE_S:
            self._finish(None)
        else:
            super().watch()

    def _awaited_at(self, step: int) -> tuple[str, ...]:
        if step not in (0, self.last_step):
            return self._plan.torques
        awaited = self._plan.topics
        return tuple(each for each in awaited if each != self._plan.clutch or not self.safe)

    def _on_complete(self) -> None:
        if self.step == self.last_step:
            self._finish(None)
        elif self._started_at is None:
            self._started_at = self._clock()
            self._on_started()

    def _take_step(self) -> None:
        replies = {topic: self._replies.get(topic) for topic in self._plan.torques}
        self.missed_steps += any(reply is None for reply in replies.values())
        for topic, reply in replies.items():
            if reply is None:
                self._miss(topic)
            else:
                self._silent_since[topic] = self.step
                self._held[topic] = reply
        clutch = self._plan.clutch
        reply = replies[clutch]
        assert reply is None or isinstance(reply, Sequence)
        self._integrate({**self._held, clutch: self._clutch_torques(reply)})

    def _clutch_torques(self, reply: Rows | None) -> Rows:
        """Return the rows of torques in N m of this period: the reply, held values, or a ramp."""
        if reply is not None and not self.safe:
            self._held_clutch = [row[-1] for row in reply]
            self._clutch.request(self.step)
            self._clutch.torque = self._held_clutch[0]
            return reply
        held = self._held_clutch
        if self._clutch.tick(self.step):
            self._held_clutch = self._ramped(held)
        return [_line(*ends) for ends in zip(held, self._held_clutch, strict=True)]

    def _ramped(self, held: list[float]) -> list[float]:
        """Return the torques in N m one period later on the ramp to zero, in proportion."""
        first = self._clutch.next_torque()
        share = first / held[0] if held[0] else 0.0
        return [first, *(max(share * other, first) for other in held[1:])]

    def _miss(self, topic: str) -> None:
        self.missed_replies[topic] += 1
        silent_s = time_of_step(self.step - self._silent_since[topic])
        if silent_s > self._plan.answer_timeout_s:
            self._finish(
                DdctError(
                    f'no {topic} since stamp {stamp_of_step(self._silent_since[topic])} ns, '
                    f'{silent_s:.2f} s ago: check that the node which publishes it is running'
                )
            )


def _line(first: float, last: float) -> list[float]:
    """Return the (11,) torques in N m of a period, linear from `first` to `last`."""
    change = (last - first) / SUBSTEPS
    return [*(first + i * change for i in range(SUBSTEPS)), last]
