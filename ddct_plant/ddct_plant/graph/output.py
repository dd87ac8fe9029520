# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Publishers of the table's topics, and the report of a node's safe state."""

from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher

from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.graph.node_names import StatusName, topic_in_graph
from ddct_plant.graph.node_reports import SAFE_STATE, safe_state_pairs
from ddct_plant.graph.qos import (
    LATCHED_QOS,
    LOOP_QOS,
    named_override_errors,
    overriding_options,
    own_copy,
)
from ddct_plant.graph.wire import serialiser
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import DIAGNOSTICS


def create_publisher(node: Node, topic: Topic) -> Publisher:
    """Return a publisher of a topic; raise ParameterError for an unusable override of its QoS."""
    qos = LATCHED_QOS if topic.latched else LOOP_QOS
    with named_override_errors(topic_in_graph(topic.name, node.get_namespace())):
        return node.create_publisher(
            topic.message_class,
            topic.name,
            own_copy(qos),
            qos_overriding_options=overriding_options(qos),
        )


class Output:
    """
    Publisher of a topic, with its message of the present tick.

    The message is serialised when it is published, so that no node waits for the serialisation of
    what is published after its own input.
    """

    def __init__(self, node: Node, topic: Topic) -> None:
        self._publisher = create_publisher(node, topic)
        self._serialise = serialiser(topic)
        self._filled: Callable[[], bytes] = bytes
        self._message: bytes | None = None

    def fill(self, stamp: int, *values: Any, **options: Any) -> 'Output':
        """Take a stamp in ns and the topic's values for the message; return this output."""
        self._filled = partial(self._serialise, stamp, *values, **options)
        self._message = None
        return self

    def publish(self) -> None:
        """Publish the message with the values of the last `fill`."""
        if self._message is None:
            self._message = self._filled()
        self._publisher.publish(self._message)


class SafeStateReport:
    """Report of a safe state: logged once, published at once and then every second."""

    def __init__(self, node: Node) -> None:
        """Publish on `/diagnostics` for `node`; in real time only, so lock-step bags have none."""
        self._node = node
        self._output = Output(node, DIAGNOSTICS)
        self._since: int | None = None

    def publish(self, step: int, stamp: int, why: str) -> None:
        """Publish the report if it is due at this tick; the first call begins the safe state."""
        if self._since is None:
            self._since = stamp
            self._node.get_logger().error(f'safe state from stamp {stamp} ns on: {why}')
        elif step % STEPS_PER_S:
            return
        pairs = safe_state_pairs(self._since, why)
        name = StatusName(self._node.get_fully_qualified_name(), SAFE_STATE)
        self._output.fill(stamp, pairs, name=str(name), error=why).publish()
