# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Base of the nodes that answer ticks: engine, load, clutch, actuator, reference, controller."""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.output import Output
from ddct_plant.graph.sole_publishers import publishers_of
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import CLOCK, tick_names
from ddct_plant.ticks.join import StampJoin
from ddct_plant.ticks.replies import StampReplies
from ddct_plant.ticks.reply_limit import ReplyLimit

Reply = Sequence[Output]
"""Outputs with filled messages, in the order of publication."""
Read = Callable[[Any], Any]
"""Function that returns the checked values of a message; it raises DdctError for bad ones."""


class FollowerNode(GraphNode):
    """
    Pure data flow: join inputs by stamp, answer once per stamp, repeat the answer on request.

    A subclass gives its inputs to `follow` and computes the reply in `answer`. Nothing in the
    trajectory reads a clock, so it does not depend on when messages arrive. In lock-step a bad
    message ends the node; in real time it counts as a missing one, and so does one that
    `ReplyLimit` refuses.
    """

    def follow(self, *inputs: Topic, readers: Mapping[Topic, Read] | None = None) -> None:
        """
        Subscribe to the inputs; the first is the trigger of `StampJoin`.

        Values are read by `Topic.read`, or by the function that `readers` has for a topic.
        """
        lockstep = self.known.lockstep
        names = [topic.name for topic in inputs]
        self.join = StampJoin(names, allow_gaps=not lockstep, shown=self.shown)
        if not lockstep:
            self.limit = ReplyLimit(tick_names(), self.shown)
        self.replies = StampReplies(
            self.join, self._answer, self.publish_reply, self._on_second_publisher
        )
        self._reply: Reply = ()
        self._disputed = False
        for topic in inputs:
            read = (readers or {}).get(topic)
            self.subscribe_values(topic, partial(self._receive, topic.name), read)
        ticks = () if lockstep or any(topic.is_tick for topic in inputs) else (CLOCK,)
        for topic in ticks:
            self.subscribe_values(
                topic, lambda stamp, _: self.on_tick(step_of_stamp(stamp), stamp)
            )
        self.log_start(*inputs, *ticks)

    @abstractmethod
    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Compute the reply to the values of one stamp; called once per stamp, in order."""

    def on_tick(self, step: int, stamp: int) -> None:
        """Handle a tick in real time, after the other callbacks of its topic; may be repeated."""

    def _receive(self, topic: str, stamp: int, values: Any) -> None:
        if not self._disputed:
            self.replies.receive(topic, stamp, values)

    def _answer(self, step: int, stamp: int, inputs: dict[str, Any]) -> None:
        try:
            self._reply = self.answer(step, stamp, inputs)
        except DdctError as error:
            raise type(error)(f'at stamp {stamp} ns: {error}') from error

    def _on_second_publisher(self, topic: str, stamp: int) -> None:
        """Raise DdctError in lock-step; in real time ignore both publishers from now on."""
        shown = self.shown(topic)
        error = DdctError(
            f'{shown} carries two different messages for stamp {stamp} ns, publishers: '
            f'{publishers_of(self, topic)}: stop one, or use another ROS_DOMAIN_ID'
        )
        if self.known.lockstep:
            raise error
        self._disputed = True
        self.get_logger().error(f'{error}; {shown} counts as missing from now on')

    def publish_reply(self) -> None:
        """Publish the reply to the last stamp, again if it was published before."""
        for output in self._reply:
            output.publish()
