# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lock-step under arbitrary schedules: the one right run, or an error that names the cause."""

from collections.abc import Mapping

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import initialize, invariant, precondition, rule
from tick_machine import TickMachine, require_of_schedules
from tick_models import RightRun
from tick_network import ACK, ONE_CLUTCH, TWO_CLUTCHES, Message, Network, Wiring, digest

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.ticks.tick_owner import RESEND_AFTER_S, TickOwner, TickPlan

STEPS = 4
MOST_WAITING = 10
"""Stamps that may wait at one node for the rest of their inputs: as many as a queue holds."""
TIMEOUT_S = 5.0
"""More than all short waits of one schedule."""


class LockstepMachine(TickMachine):
    """The owner of time and its followers on a network without any promise."""

    steps = STEPS

    @initialize(
        wiring=st.sampled_from([ONE_CLUTCH, TWO_CLUTCHES]),
        recorder=st.booleans(),
        nodes_stay=st.booleans(),
    )
    def begin(self, wiring: Wiring, recorder: bool, nodes_stay: bool) -> None:
        self.nodes_stay = nodes_stay
        wiring = wiring.with_recorder() if recorder else wiring
        self.set_up(wiring)
        self.right = RightRun(wiring, STEPS)
        self.now, self.opened_at, self.steps_taken = 0.0, 0.0, 0
        self.state = 0.0
        self.failures: dict[str, DdctError] = {}
        self.crowded: set[str] = set()
        self.heard: set[str] = set()
        self.network = Network(
            wiring, self.hear, allow_gaps=False, on_answer=self.require_right_inputs
        )
        acknowledged = ACK if recorder else ''
        self.awaited = [*wiring.torques, *([ACK] if recorder else [])]
        self.owner = TickOwner(
            self.integrate,
            TickPlan(wiring.torques, wiring.clutches, acknowledged, STEPS, TIMEOUT_S),
            self.publish_tick,
            self.ends.append,
            clock=lambda: self.now,
        )
        self.owner.start()

    def publish_tick(self, step: int) -> None:
        assert step == self.steps_taken, 'a tick is only published after its own step'
        for topic in self.wiring.ticks:
            self.network.publish(topic, step, digest(topic, step, self.state))

    def integrate(self, *torques: object) -> None:
        """Require the torques of this very step, and the acknowledgement where it is awaited."""
        right = self.right.ticks[self.steps_taken]
        values = [each[0] if isinstance(each, list) else each for each in torques]
        assert values == [right[topic] for topic in self.wiring.torques]
        assert self.heard == set(self.awaited), 'a step without all of its replies'
        self.state = digest(self.steps_taken, values)
        self.steps_taken += 1
        self.opened_at, self.heard = self.now, set()

    def require_right_inputs(self, node: str, step: int, inputs: Mapping[str, float]) -> None:
        """Require that a reply is computed once per stamp, in order, of that stamp alone."""
        assert step == self.answered[node] + 1
        self.answered[node] = step
        right = self.right.ticks[step]
        assert inputs == {topic: right[topic] for topic in self.wiring.nodes[node].inputs}

    def hear(self, message: Message) -> None:
        if message.step == self.steps_taken and message.topic in self.awaited:
            self.heard.add(message.topic)
        self.offer(message)

    def deliver(self, message: Message) -> None:
        """Deliver to a reader that lives; an error ends the reader as it ends a node."""
        try:
            super().deliver(message)
        except DdctError as error:
            self.failures[message.reader] = error
            self.dead.add(message.reader)

    @precondition(lambda self: not self.over)
    @rule(wait_s=st.sampled_from([0.02, 0.11]))
    def wait(self, wait_s: float) -> None:
        self.now += wait_s
        self.owner.watch()

    @precondition(lambda self: not self.over and not self.nodes_stay)
    @rule()
    def wait_for_long(self) -> None:
        self.now += 1.01 * TIMEOUT_S
        self.owner.watch()

    def start_again(self, name: str) -> None:
        super().start_again(name)
        self.failures.pop(name, None)
        self.crowded.discard(name)

    def after_stamps_of_no_step(self, name: str, many: bool) -> None:
        """Require that a node ends which has no room for the stamps of the run any more."""
        assert many == (name in self.dead)
        if many:
            self.crowded.add(name)

    @invariant()
    def errors_name_their_cause(self) -> None:
        for name, error in self.failures.items():
            inputs = self.wiring.nodes[name].inputs
            if name in self.crowded:
                assert f'came while {MOST_WAITING} others wait' in str(error)
                assert f'check what publishes {" and ".join(inputs)}' in str(error)
                assert error.key in inputs
            else:
                assert name in self.restarted, f'{name} ended though it was there from the start'
                assert 'came where step 0 was due' in str(error)
                assert error.key == inputs[0]
        if self.over and self.ends[0] is not None:
            self.require_named_silence(self.ends[0])

    def require_named_silence(self, error: DdctError) -> None:
        missing = [topic for topic in self.awaited if topic not in self.heard]
        assert self.now - self.opened_at > TIMEOUT_S
        stamp = stamp_of_step(self.steps_taken)
        assert str(error).startswith(f'no {" and no ".join(missing)} for stamp {stamp} ns')

    def teardown(self) -> None:
        """From now on nothing is lost: the run ends, well unless a node is gone."""
        if not hasattr(self, 'owner'):
            return
        # One more repetition than ticks are left, for the one in which something was lost.
        for _ in range(STEPS + 2):
            self.arrive_all()
            if self.over:
                break
            self.now += 1.01 * RESEND_AFTER_S
            self.owner.watch()
        gone = self.dead | self.restarted
        if not self.over:
            assert gone, 'with every node there the run stands still'
            self.now += 1.01 * TIMEOUT_S
            self.owner.watch()
        if self.ends[0] is None:
            assert self.steps_taken == STEPS
        self.errors_name_their_cause()


@pytest.mark.slow
def test_lock_step_takes_the_one_right_run_or_names_the_cause_whatever_the_schedule():
    require_of_schedules(LockstepMachine, rules=30)
