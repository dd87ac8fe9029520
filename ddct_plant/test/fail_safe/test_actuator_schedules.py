# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The fail-safe of the actuator under arbitrary schedules of requests and ticks."""

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule
from tick_machine import require_of_schedules

from ddct_plant.fail_safe.guarded import GuardedActuator
from ddct_plant.fail_safe.request_watch import FailSafeSettings
from ddct_plant.models.actuator import Actuator

INITIAL_N_M = 200.0
TORQUES = st.sampled_from([-15.0, 0.0, 90.0, 200.0, 350.0])


class ActuatorMachine(RuleBasedStateMachine):
    """
    Requests and ticks that are lost, late, doubled and out of order.

    The model is the list of what each step requests of a bare actuator: a request that came in
    time, else the last one, and from the tick that finds requests missing a ramp to zero.
    """

    @initialize(timeout_steps=st.integers(1, 6), ramp=st.sampled_from([3.0, 40.0, 1000.0]))
    def begin(self, timeout_steps: int, ramp: float) -> None:
        self.timeout_steps, self.ramp = timeout_steps, ramp
        settings = FailSafeSettings(0.01 * timeout_steps, 100.0 * ramp)
        self.guarded = GuardedActuator(Actuator(INITIAL_N_M), INITIAL_N_M, settings)
        self.bare = Actuator(INITIAL_N_M)
        self.now = 0
        self.requested: list[float] = []
        self.newest: int | None = None
        self.opens = False
        self.last_answer: list[float] | None = None

    def deliver(self, request: float) -> list[float]:
        """Return the torque of the bare actuator at the step after `requested`."""
        self.requested.append(request)
        self.last_answer = self.bare.update(request)
        return self.last_answer

    def hold_until(self, step: int) -> None:
        """Fill the steps without a request."""
        while len(self.requested) < step:
            self.deliver(self.opened() if self.opens else self.held())

    def held(self) -> float:
        return self.requested[-1] if self.requested else INITIAL_N_M

    def opened(self) -> float:
        """Return the next request of the ramp to zero."""
        left = max(abs(self.held()) - self.ramp, 0.0)
        return left if self.held() > 0.0 else -left

    @rule(steps=st.integers(1, 9))
    def time_passes(self, steps: int) -> None:
        self.now += steps

    @rule(back=st.integers(0, 4), torque=TORQUES)
    def a_request_arrives(self, back: int, torque: float) -> None:
        step = max(self.now - back, 0)
        self.newest = step if self.newest is None else max(self.newest, step)
        answer = self.guarded.request(step, torque)
        if self.opens or step < len(self.requested):
            assert answer is None, 'a late request, or one after the safe state, is ignored'
            return
        self.hold_until(step)
        assert answer == self.deliver(torque)

    @rule(back=st.sampled_from([0, 0, 0, 1, 3]))
    def a_tick_arrives(self, back: int) -> None:
        step = max(self.now - back, 0)
        answer = self.guarded.tick(step)
        if not self.opens:
            if self.newest is None or step - self.newest <= self.timeout_steps:
                assert answer is None, 'a request may still come'
                return
            self.hold_until(step)
            self.opens = True
        if step >= len(self.requested):
            self.hold_until(step + 1)
        expected = self.last_answer if step == len(self.requested) - 1 else None
        assert answer == expected

    @rule(steps=st.integers(1, 12))
    def requests_go_on_in_time(self, steps: int) -> None:
        for _ in range(steps):
            self.time_passes(1)
            self.a_tick_arrives(0)
            self.a_request_arrives(0, 120.0)

    @rule(steps=st.integers(1, 12))
    def ticks_go_on_without_requests(self, steps: int) -> None:
        for _ in range(steps):
            self.time_passes(1)
            self.a_tick_arrives(0)

    @invariant()
    def the_safe_state_stays(self) -> None:
        if hasattr(self, 'guarded'):
            assert self.guarded.watch.stopped == self.opens


@pytest.mark.slow
def test_the_actuator_holds_opens_and_stays_open_whatever_the_schedule() -> None:
    require_of_schedules(ActuatorMachine, rules=30)
