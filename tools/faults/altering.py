# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node between the publisher of a topic and its readers, or one of them."""

from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from ddct_plant.bag_file.cdr import stamp_of_cdr
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.signals.topic import Topic

Alter = Callable[['AlteringNode', int, bytes], None]
"""Function of the node, the step of a message and its bytes: it sends what shall arrive."""


class AlteringNode(Node):
    """Node that receives a topic under one name, and sends under another what `alter` makes."""

    def __init__(
        self, topic: Topic, source: str, target: str, alter: Alter, **options: Any
    ) -> None:
        """Subscribe to the name `source`, publish the name `target`."""
        super().__init__(f'between_{target.strip("/").replace("/", "_")}', **options)
        self._alter = alter
        self._clock_of_delays = Clock(clock_type=ClockType.STEADY_TIME)
        publisher = self.create_publisher(topic.message_class, target, RECORDER_QOS)
        self.send: Callable[[bytes], None] = publisher.publish
        self.create_subscription(
            topic.message_class, source, self._receive, RECORDER_QOS, raw=True
        )

    def _receive(self, cdr: bytes) -> None:
        self._alter(self, step_of_stamp(stamp_of_cdr(cdr)), cdr)

    def send_later(self, cdr: bytes, delay_s: float) -> None:
        """Send a message after a time in s on a steady clock."""

        def send() -> None:
            timer.cancel()
            self.send(cdr)

        timer = self.create_timer(delay_s, send, clock=self._clock_of_delays)
