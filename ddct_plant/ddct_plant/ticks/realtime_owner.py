# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The owner of time at 100 Hz on a steady clock; does not depend on ROS."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_NS, PERIOD_S, START_NS, stamp_of_step, time_of_step
from ddct_plant.fail_safe.guarded_clutch import GuardedClutch
from ddct_plant.ticks.durations import TickDurations
from ddct_plant.ticks.tick_owner import Reply, TickOwner

RECORDER_PATIENCE_S = 2.0
"""Longest wait in s of a real-time run at t_N for the recorder, which may have missed a reply."""


class RealtimeOwner(TickOwner):
    """
    Step on a steady 10 ms grid with the replies to the previous tick, and count missing replies.

    At t_0 the owner waits for all replies as in lock-step, recorder included: the start barrier.
    At t_N it waits for the torques, which end the run, and up to `RECORDER_PATIENCE_S` for the
    recorder. In between a missing torque is held at its last value. When the torque of a clutch is
    missing for longer than its timeout, that clutch goes to its safe state: see `GuardedClutch`.
    """

    def __init__(
        self, *arguments: Any, on_started: Callable[[], object] = lambda: None, **options: Any
    ) -> None:
        """Accept the arguments of `TickOwner`; call `on_started` when the 10 ms grid begins."""
        super().__init__(*arguments, **options)
        self._on_started = on_started
        self.missed_replies = dict.fromkeys(self._plan.torques, 0)
        self.durations = TickDurations(self._clock)
        self._held: dict[str, Reply] = {}
        self._silent_since: dict[str, int] = dict.fromkeys(self._plan.torques, 0)
        self._clutches = {
            topic: GuardedClutch(self._plan.fail_safe) for topic in self._plan.clutches
        }
        self._started_at: float | None = None
        self._late_s = 0.0

    @property
    def safe_clutches(self) -> list[str]:
        """Topics of the clutch torques that have timed out and are on their way to zero."""
        return [topic for topic, clutch in self._clutches.items() if clutch.safe]

    def tick(self) -> None:
        """Integrate every step that is due by the wall clock."""
        if self._started_at is None:
            return
        while self.step < self.last_step:
            due = self._started_at + (self.step + 1) * PERIOD_S
            now = self._clock()
            if now < due:
                return
            self._late_s = now - due
            self._take_step()

    def offer(self, topic: str, stamp_ns: int, reply: Reply) -> None:
        """Add one reply, and note how long that of a clutch took."""
        if topic in self._clutches and self._started_at is not None:
            self.durations.answer((stamp_ns - START_NS) // PERIOD_NS)
        super().offer(topic, stamp_ns, reply)

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

    def _open(self, step: int) -> None:
        if self._started_at is not None:
            self.durations.publish(self._late_s)
        super()._open(step)

    def _awaited_at(self, step: int) -> tuple[str, ...]:
        if step not in (0, self.last_step):
            return self._plan.torques
        safe = self.safe_clutches
        return tuple(topic for topic in self._plan.topics if topic not in safe)

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
        self._step(self._held | self._clutch_torques(replies))

    def _clutch_torques(self, replies: Mapping[str, Reply]) -> dict[str, Reply]:
        """Return the rows of torques in N m of each clutch over this period, by topic."""
        rows: dict[str, Reply] = {}
        for topic, clutch in self._clutches.items():
            reply = replies[topic]
            assert reply is None or isinstance(reply, Sequence)
            rows[topic] = clutch.torques(self.step, reply)
        return rows

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
