# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The owner of time: when the driveline steps, and on which replies. Independent of ROS."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.fail_safe.guarded_clutch import Rows
from ddct_plant.fail_safe.request_watch import CLUTCH_TIMEOUT_S, FailSafeSettings

Reply = float | Rows | None
"""Values of a reply: a torque in N m, those of the clutch, or None for an acknowledgement."""
RESEND_AFTER_S = 0.1
"""Time in s after which an unanswered tick is published again."""
PROOF = 30
"""Number of replies to t_0 with a later stamp, one for each time that it is sent, by which a node
has proved that it has run already."""


@dataclass(frozen=True)
class TickPlan:
    """Length of a run, topics of the replies to its ticks, and timeouts."""

    torques: tuple[str, ...]
    """Topics of the torques that the driveline integrates, in the order that it takes them."""
    clutches: tuple[str, ...]
    """Topics with rows of 11 torques, one for each clutch: the transmitted torque, or kinetic and
    static capacity. Each of the other topics has one number."""
    recorder: str
    """Topic on which the recorder acknowledges a tick; empty where the run does not wait for
    it."""
    steps: int
    """N, the number of periods: states run from t_0 to t_N."""
    answer_timeout_s: float
    """Wall time in s after which an unanswered tick ends the run."""
    fail_safe: FailSafeSettings = field(default_factory=lambda: FailSafeSettings(CLUTCH_TIMEOUT_S))
    """Real time: timeout of a clutch torque, and rate at which it then runs to zero."""

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics of all replies that complete a tick."""
        return (*self.torques, self.recorder) if self.recorder else self.torques


class TickOwner:
    """
    Publish a tick, wait for every reply stamped exactly t_k, integrate, go on: lock-step.

    Any other message is ignored, so that old data never enters a step. `integrate(*torques)` takes
    the driveline over one period, with the torques of the plan in their order and each row of a
    clutch apart. `publish(step)` sends its present outputs; `finish(error)` ends the run.
    """

    def __init__(
        self,
        integrate: Callable[..., None],
        plan: TickPlan,
        publish: Callable[[int], None],
        finish: Callable[[DdctError | None], None],
        clock: Callable[[], float],
        over: Callable[[], bool] = lambda: False,
    ) -> None:
        self.step = 0
        self.last_step = plan.steps
        """Last step of the run: N, or the first step at which `over()` is true."""
        self.resends = 0
        self.missed_steps = 0
        self.late = 0
        """Number of replies to a tick that was already complete."""
        self._awaited: tuple[str, ...] = ()
        self._have_run: Counter[str] = Counter()
        """Number of replies to a later tick that came before the first step, by topic."""
        self._replies: dict[str, Reply] = {}
        """Replies to the present tick that have arrived, by topic."""
        self._integrate = integrate
        self._plan = plan
        self._publish = publish
        self._finish = finish
        self._clock = clock
        self._over = over
        self._opened_at = 0.0
        self._sent_at = 0.0

    def start(self) -> None:
        """Publish t_0; it is re-sent until every node has answered, so any start order works."""
        self._open(0)

    def offer(self, topic: str, stamp_ns: int, reply: Reply) -> None:
        """Add one reply; the reply that completes the tick makes the driveline step."""
        due = stamp_of_step(self.step)
        if self.step == 0 and stamp_ns > due:
            self._have_run[topic] += 1
        if stamp_ns != due or topic not in self._awaited or topic in self._replies:
            self.late += stamp_ns < due
            return
        self._replies[topic] = reply
        if len(self._replies) == len(self._awaited):
            self._on_complete()

    def missing(self) -> list[str]:
        """Return the topics whose reply is missing, in the order of the plan."""
        return [topic for topic in self._awaited if topic not in self._replies]

    def watch(self) -> None:
        """Send an unanswered tick again, or end the run; called every few ms of wall time."""
        now = self._clock()
        missing = self.missing()
        if not missing:
            return
        waited_s = min(now - self._opened_at, self._plan.answer_timeout_s)
        # One false stamp proves nothing.
        begun_anew = self.step == 0 and all(self._have_run[each] >= PROOF for each in missing)
        if now - self._opened_at > self._plan.answer_timeout_s or begun_anew:
            self._finish(
                DdctError(
                    f'no {" and no ".join(missing)} for stamp {stamp_of_step(self.step)} ns '
                    f'(step {self.step}) within {round(waited_s, 1):g} s: ' + self._advice(missing)
                )
            )
        elif now - self._sent_at > RESEND_AFTER_S:
            self._sent_at = now
            self.resends += 1
            self._publish(self.step)

    def _advice(self, missing: Sequence[str]) -> str:
        if self.step == 0 and (have_run := [each for each in missing if self._have_run[each]]):
            return (
                f'the nodes which publish {" and ".join(have_run)} have already run with another '
                'driveline, so stop all nodes and start the graph again'
            )
        nodes = [f'/{topic.rpartition("/")[0]}' for topic in missing]
        return (
            f'check that {", ".join(nodes)} and what they wait for run, and read their logs: a '
            'node that refused a message says why'
        )

    def _awaited_at(self, step: int) -> tuple[str, ...]:
        return self._plan.topics

    def _on_complete(self) -> None:
        if self.step == self.last_step:
            self._finish(None)
        else:
            self._step(self._replies)

    def _open(self, step: int) -> None:
        self.step = step
        self._awaited = self._awaited_at(step)
        self._replies = {}
        self._opened_at = self._sent_at = self._clock()
        self._publish(step)

    def _step(self, replies: Mapping[str, Reply]) -> None:
        torques: list[Any] = []
        for topic in self._plan.torques:
            reply = replies[topic]
            torques += reply if isinstance(reply, Sequence) else (reply,)
        self._integrate(*torques)
        if self._over():
            self.last_step = self.step + 1
        self._open(self.step + 1)
