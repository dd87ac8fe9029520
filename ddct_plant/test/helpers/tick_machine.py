# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What schedules of lock-step and of real time have in common, for the machines of hypothesis."""

import os

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    invariant,
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
SCHEDULES = 'DDCT_SCHEDULES'
"""Environment variable with the number of schedules of a longer run, whose seeds are new ones."""
_FEW, _MANY = 5, 12
"""Numbers of stamps of a stranger at one node: few leave room for those of the run, many none."""


class TickMachine(RuleBasedStateMachine):
    """
    An owner of time and its followers; messages are lost, late and repeated, nodes end.

    Strangers publish on the topics of the run, too: other values for a tick, and false stamps.
    """

    steps: int
    """Number of periods of the run."""
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
        self.spoilt: dict[str, str] = {}
        """Topic, by its reader, on which a stranger sends stamps that the run never comes to."""
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

    @precondition(lambda self: not self.over and max(self.answered.values()) >= 0)
    @rule(pick=INDEX)
    def a_second_publisher_sends_another_tick(self, pick: int) -> None:
        """Both ticks get no reply: in lock-step the node ends, in real time it takes no more."""
        names = [name for name, last in self.answered.items() if last >= 0]
        name = names[pick % len(names)]
        if name in self.dead:
            return
        trigger, step = self.wiring.nodes[name].inputs[0], self.answered[name]
        on_way = len(self.network.on_way)
        self.network.deliver(Message(name, trigger, step, -1.0))
        assert self.network.disputes.pop() == (name, trigger, stamp_of_step(step))
        assert len(self.network.on_way) == on_way
        if not self.nodes_stay:
            self.dead.add(name)

    @invariant()
    def only_repeated_ticks_are_disputed(self) -> None:
        assert self.network.disputes == []

    @precondition(lambda self: not self.over)
    @rule(off=st.integers(-30_000_000, 3_000_000_000))
    def a_reply_with_a_false_stamp_comes(self, off: int) -> None:
        """Require that the owner of time ignores it, off the grid, too late or too early."""
        stamp = stamp_of_step(self.owner.step) + off
        if off:
            for topic in self.owner.missing():
                self.owner.offer(topic, stamp, 1.0)

    @precondition(lambda self: not self.over)
    @rule(pick=INDEX, many=st.booleans())
    def a_stranger_sends_stamps_of_no_step(self, pick: int, many: bool) -> None:
        """
        One topic of a node with several inputs carries stamps that this run never comes to.

        On all of its inputs they would be complete: `ReplyLimit`, which is no part of this model,
        refuses those of replies in real time.
        """
        name = self.node_at(pick)
        inputs = self.wiring.nodes[name].inputs
        if name in self.dead or len(inputs) == 1 or (many and self.nodes_stay):
            return
        topic = self.spoilt.setdefault(name, inputs[pick % len(inputs)])
        for ahead in range(1, 1 + (_MANY if many else _FEW)):
            self.deliver(Message(name, topic, self.steps + ahead, -1.0))
        self.after_stamps_of_no_step(name, many)

    def after_stamps_of_no_step(self, name: str, many: bool) -> None:
        """Require what must follow from few or many of them at a node of several inputs."""


def require_of_schedules(machine: type[RuleBasedStateMachine], rules: int) -> None:
    """
    Require what a machine states of schedules of at most `rules` rules.

    They are 30, always the same, or the number in `SCHEDULES`, new ones in each run.
    """
    longer = os.environ.get(SCHEDULES)
    run_state_machine_as_test(
        machine,
        settings=settings(
            max_examples=int(longer or 30),
            stateful_step_count=rules,
            derandomize=not longer,
            database=None,
            deadline=None,
            report_multiple_bugs=False,
            suppress_health_check=list(HealthCheck),
        ),
    )
