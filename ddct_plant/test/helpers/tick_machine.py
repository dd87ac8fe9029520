# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What schedules of lock-step and of real time have in common, for the machines of hypothesis."""

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    precondition,
    rule,
    run_state_machine_as_test,
)
from tick_network import Message, Network, Wiring

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.ticks.realtime_owner import RealtimeOwner
from ddct_plant.ticks.tick_owner import Reply, TickOwner

INDEX = st.integers(0, 10**6)


class TickMachine(RuleBasedStateMachine):
    """An owner of time and its followers; messages are lost, late and repeated, nodes end."""

    wiring: Wiring
    network: Network
    owner: TickOwner | RealtimeOwner
    nodes_stay = False
    """Whether no node of this schedule is killed or started again."""

    def set_up(self, wiring: Wiring) -> None:
        """Begin with every node there, and nothing answered."""
        self.wiring = wiring
        self.answered = dict.fromkeys(wiring.nodes, -1)
        self.dead: set[str] = set()
        self.restarted: set[str] = set()
        self.ends: list[DdctError | None] = []

    @property
    def over(self) -> bool:
        return bool(self.ends)

    def deliver(self, message: Message) -> None:
        """Deliver to a reader that lives, before the end of the run."""
        if message.reader not in self.dead and not self.over:
            self.network.deliver(message)

    def offer(self, message: Message) -> None:
        """Pass a reply to the owner, that of a clutch as the rows of a period."""
        reply: Reply = message.value
        if message.topic in self.wiring.clutches:
            reply = ([message.value] * 11,)
        self.owner.offer(message.topic, stamp_of_step(message.step), reply)

    def start_again(self, name: str) -> None:
        """Start a node without any memory."""
        self.network.start(name)
        self.answered[name] = -1
        self.dead.discard(name)
        self.restarted.add(name)

    def node_at(self, pick: int) -> str:
        return sorted(self.wiring.nodes)[pick % len(self.wiring.nodes)]

    @precondition(lambda self: self.network.on_way)
    @rule(picks=st.lists(INDEX, min_size=1, max_size=40))
    def arrive_in_any_order(self, picks: list[int]) -> None:
        for pick in picks:
            if self.network.on_way:
                self.deliver(self.network.take(pick))

    def arrive_all(self) -> None:
        """Deliver everything in the order of sending, and what that causes."""
        while self.network.on_way and not self.over:
            self.deliver(self.network.take(0))

    @precondition(lambda self: self.network.on_way)
    @rule(pick=INDEX)
    def lose(self, pick: int) -> None:
        self.network.take(pick)

    @precondition(lambda self: self.network.arrived)
    @rule(pick=INDEX)
    def arrive_once_more(self, pick: int) -> None:
        self.deliver(self.network.arrived[pick % len(self.network.arrived)])

    @precondition(lambda self: not self.nodes_stay)
    @rule(pick=INDEX)
    def restart_a_node(self, pick: int) -> None:
        self.start_again(self.node_at(pick))

    @precondition(lambda self: not self.nodes_stay)
    @rule(pick=INDEX)
    def kill_a_node(self, pick: int) -> None:
        self.dead.add(self.node_at(pick))


def require_of_schedules(machine: type[RuleBasedStateMachine], rules: int) -> None:
    """Require what a machine states of 150 schedules of at most `rules` rules, always the same."""
    run_state_machine_as_test(
        machine,
        settings=settings(
            max_examples=150,
            stateful_step_count=rules,
            derandomize=True,
            database=None,
            deadline=None,
            report_multiple_bugs=False,
            suppress_health_check=list(HealthCheck),
        ),
    )
