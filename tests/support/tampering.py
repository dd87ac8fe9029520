# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node that forwards one topic to one reader and, from one step on, changes its messages."""

from collections.abc import Callable
from typing import Any

from rclpy.node import Node

from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.signals.message_kind import stamp_ns


def tampered_remap(topic: str) -> list[str]:
    """Return the ROS arguments by which a node receives `topic` only from a `Tamperer`."""
    return ['--ros-args', '-r', f'{topic}:=tampered/{topic}']


class Tamperer(Node):
    """Node that forwards `topic`; from `from_step` on `spoil` changes each message."""

    def __init__(
        self,
        message_type: type,
        topic: str,
        spoil: Callable[[Any], None],
        from_step: int,
        **options: Any,
    ) -> None:
        """Change the messages that the reader with `tampered_remap(topic)` receives."""
        super().__init__('tamperer', **options)
        self._spoil = spoil
        self._from_step = from_step
        self._publisher = self.create_publisher(message_type, f'tampered/{topic}', RECORDER_QOS)
        self.create_subscription(message_type, topic, self._hand_on, RECORDER_QOS)

    def _hand_on(self, message: Any) -> None:
        if step_of_stamp(stamp_ns(message)) >= self._from_step:
            self._spoil(message)
        self._publisher.publish(message)
