# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time under arbitrary schedules: steps on the grid, with what came in time or held."""

from collections.abc import Mapping

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import initialize, invariant, precondition, rule
from tick_machine import TickMachine, require_of_schedules
from tick_models import CLUTCH_STEPS, RAMP_N_M, HeldTorque
from tick_network import ACK, ONE_CLUTCH, TWO_CLUTCHES, Message, Network, Wiring, digest

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.fail_safe.request_watch import FailSafeSettings
from ddct_plant.ticks.realtime_owner import RECORDER_PATIENCE_S, RealtimeOwner
from ddct_plant.ticks.tick_owner import TickPlan

STEPS = 80
SILENCE_STEPS = 40
"""Steps for which a torque may be missing before the run ends."""


class RealtimeMachine(TickMachine):
    """The owner of time on its grid, its followers, and a network without any promise."""

    steps = STEPS

    @initialize(wiring=st.sampled_from([ONE_CLUTCH, TWO_CLUTCHES]), recorder=st.booleans())
    def begin(self, wiring: Wiring, recorder: bool) -> None:
        wiring = wiring.with_recorder() if recorder else wiring
        self.set_up(wiring)
        self.ms, self.started_ms, self.opened_ms = 0.5, 0.0, 0.5
        self.step, self.state = 0, 0.0
        self.missed = dict.fromkeys(wiring.torques, 0)
        self.missed_steps = 0
        self.heard: dict[str, float] = {}
        self.held = {topic: HeldTorque(topic in wiring.clutches) for topic in wiring.torques}
        self.published: dict[tuple[str, int], float] = {}
        self.silent: list[str] = []
        self.network = Network(
            wiring, self.hear, allow_gaps=True, on_answer=self.require_inputs_of_one_stamp
        )
        fail_safe = FailSafeSettings(0.01 * CLUTCH_STEPS, 100.0 * RAMP_N_M)
        plan = TickPlan(
            wiring.torques,
            wiring.clutches,
            ACK if recorder else '',
            STEPS,
            0.01 * SILENCE_STEPS,
            fail_safe,
        )
        self.awaited = plan.topics
        self.owner = RealtimeOwner(
            self.integrate,
            plan,
            self.publish_tick,
            self.finish,
            clock=lambda: 1e-3 * self.ms,
            on_started=self.start_grid,
        )
        self.owner.start()

    def start_grid(self) -> None:
        assert set(self.heard) == set(self.awaited), 't_0 waits for everybody'
        # Half a millisecond off the grid, so that no rounding decides what is due.
        self.started_ms, self.ms = self.ms, self.ms + 0.5

    @property
    def started(self) -> bool:
        return self.started_ms > 0.0

    def publish_tick(self, step: int) -> None:
        assert step == self.step
        for topic in self.wiring.ticks:
            value = digest(topic, step, self.state)
            assert self.published.setdefault((topic, step), value) == value
            self.network.publish(topic, step, value)

    def integrate(self, *torques: object) -> None:
        """Require what came for this very step in time, and else what is held."""
        if not self.over:
            for topic, given in zip(self.wiring.torques, torques, strict=True):
                value = self.heard.get(topic)
                first, last = self.held[topic].over(self.step, value)
                ends = (given[0], given[-1]) if isinstance(given, list) else (given, given)
                assert ends == pytest.approx((first, last), abs=1e-9), topic
                self.missed[topic] += value is None
            self.missed_steps += any(topic not in self.heard for topic in self.wiring.torques)
            assert not self.silent_topics(), 'the run goes on after a silence'
        self.state = digest(self.step, torques)
        self.step += 1
        self.heard, self.opened_ms = {}, self.ms

    def silent_topics(self) -> list[str]:
        """Return the torques that have been missing for too long, this step included."""
        return [
            topic
            for topic, held in self.held.items()
            if topic not in self.heard and self.step - held.heard_at > SILENCE_STEPS
        ]

    def finish(self, error: DdctError | None) -> None:
        """Note the end of the run; the node takes the first one alone."""
        if not self.ends:
            self.silent = self.silent_topics() if 0 < self.step < STEPS else []
            self.ends.append(error)

    def require_inputs_of_one_stamp(
        self, node: str, step: int, inputs: Mapping[str, float]
    ) -> None:
        assert step > self.answered[node], 'no stamp twice, and none after a later one'
        self.answered[node] = step
        wires = self.wiring.nodes[node]
        assert inputs == {topic: self.published[topic, step] for topic in wires.inputs}

    def hear(self, message: Message) -> None:
        """Pass a reply to the owner, and note it if it answers the present tick."""
        if message.step == self.step and message.topic in self.awaited:
            self.heard.setdefault(message.topic, message.value)
        self.offer(message)

    def deliver(self, message: Message) -> None:
        if message.reader not in self.dead and not self.over:
            self.published.setdefault((message.topic, message.step), message.value)
        super().deliver(message)

    @rule()
    def arrive_all(self) -> None:
        super().arrive_all()

    @precondition(lambda self: not self.over)
    @rule(ms=st.sampled_from([3, 10, 10, 10, 25, 60, 150]))
    def time_passes(self, ms: int) -> None:
        """Let the timers of the driveline run after a while."""
        self.ms += ms
        if self.started:
            self.owner.tick()
        if not self.over:
            self.owner.watch()

    @rule(steps=st.integers(1, 30))
    def periods_in_time(self, steps: int) -> None:
        for _ in range(steps):
            if not self.over:
                self.time_passes(10)
                self.it_never_waits()
                self.arrive_all()

    @invariant()
    def it_never_waits(self) -> None:
        """Every step that is due is taken, whatever is missing, and none before."""
        if self.started and not self.over:
            due = int((self.ms - self.started_ms) / 10.0)
            assert self.owner.step == self.step == min(due, STEPS)

    @invariant()
    def what_was_missing_is_counted(self) -> None:
        if not self.over:
            assert self.owner.missed_replies == self.missed
            assert self.owner.missed_steps == self.missed_steps
            assert self.owner.safe_clutches == [t for t, held in self.held.items() if held.safe]

    @invariant()
    def an_end_has_its_cause(self) -> None:
        if not self.over:
            return
        # The owner subtracts rounded times, so that a wait of just the limit may be beyond it.
        end, waited_s = self.ends[0], 1e-3 * (self.ms - self.opened_ms) + 1e-9
        safe = [topic for topic, held in self.held.items() if held.safe]
        missing = [t for t in self.awaited if t not in self.heard and t not in safe]
        if end is None:
            assert self.step == STEPS
            assert missing == [] or (missing == [ACK] and waited_s > RECORDER_PATIENCE_S)
        elif self.silent:
            since = stamp_of_step(self.held[self.silent[0]].heard_at)
            assert str(end).startswith(f'no {self.silent[0]} since stamp {since} ns')
        else:
            assert self.step in (0, STEPS)
            assert waited_s > 0.01 * SILENCE_STEPS
            assert str(end).startswith(f'no {" and no ".join(missing)} for stamp')

    def teardown(self) -> None:
        """From now on every node answers each tick in time: nothing is missed, the run ends."""
        if not hasattr(self, 'owner') or self.over:
            return
        fair_from_ms = self.ms
        for name in sorted(self.dead):
            self.start_again(name)
        self.arrive_all()
        # A tick is sent again at the start and at the end, where something may have been lost.
        first = True  # whether the tick that a step answers is older
        for _ in range(STEPS + 40):
            if self.ends:
                break
            missed, first = self.missed_steps, self.opened_ms <= fair_from_ms
            self.time_passes(10)
            assert self.ends or first or self.missed_steps == missed
            self.it_never_waits()
            self.arrive_all()
        self.an_end_has_its_cause()
        assert self.ends[0] is None or first


@pytest.mark.slow
def test_real_time_steps_on_its_grid_with_what_came_in_time_whatever_the_schedule():
    require_of_schedules(RealtimeMachine, rules=40)
