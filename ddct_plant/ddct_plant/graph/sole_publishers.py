# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Check that each topic of the loop has one live publisher."""

import time
from collections.abc import Callable

from rclpy.node import Node
from rclpy.subscription import Subscription

from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.signals.message_kind import ros_class
from ddct_plant.signals.topics import all_topics
from ddct_plant.ticks.sequence import SequenceWatch

CHECK_S = 0.2
"""Period in s of the check, and of repeated requests for the last replies at a doubtful end."""
PROOF_S = 1.0
"""
Time in s for which a second publisher in the graph keeps a run from ending without an error.

Between two checks at most `CHECK_S` counts, so that a process that could not run, and could
receive nothing, does not take silence for proof.
"""
OPEN_S = 1.0
"""Time in s that a real-time run goes on with a second publisher, with an open clutch."""


def publishers_of(node: Node, topic: str) -> str:
    """Return the names of all publishers of a topic of `node` in the ROS graph."""
    shown = node.get_publishers_info_by_topic(node.resolve_topic_name(topic))
    names = sorted(f'{each.node_namespace.rstrip("/")}/{each.node_name}' for each in shown)
    return ' and '.join(names)


class _Probe:
    """Reader of the sequence numbers of one topic, which an executor does not pass on."""

    def __init__(self, node: Node, topic: str, type_name: str) -> None:
        self.listened_s = 0.0
        """Time in s for which messages could arrive."""
        self._checked_at = time.monotonic()
        self.subscription: Subscription = node.create_subscription(
            ros_class(type_name), topic, lambda _: None, RECORDER_QOS, raw=True
        )
        self._watch = SequenceWatch()

    def two_alive(self) -> bool:
        """Take the messages that have arrived; return whether two publishers sent them."""
        now = time.monotonic()
        self.listened_s += min(now - self._checked_at, CHECK_S)
        self._checked_at = now
        handle, message_type = self.subscription.handle, self.subscription.msg_type
        while (taken := handle.take_message(message_type, True)) is not None:
            self._watch.note(taken[1]['publication_sequence_number'])
        return self._watch.two_alive


class SolePublishers:
    """
    Detect a second live publisher of any topic of the loop.

    The ROS graph alone proves nothing: it lists a killed node for 20 s. Where it lists two
    publishers, a subscription checks whether messages of both arrive. In lock-step that ends the
    node. In real time the node goes to its safe state, and ends `OPEN_S` later.
    """

    def __init__(self, node: GraphNode, repeat: Callable[[], None]) -> None:
        """Check from a timer of `node`; `repeat()` makes every follower repeat its reply."""
        self._node = node
        self.found: DdctError | None = None
        """Error that names the second publisher; None before one is found."""
        self._topics = {
            topic.name: node.resolve_topic_name(topic.name)
            for topic in all_topics()
            if topic.every_tick
        }
        self._repeat = repeat
        self._listener: Node | None = None
        self._probes: dict[str, _Probe] = {}
        self._at_end = False
        node.every(CHECK_S, self._on_timer)

    def finish(self, error: DdctError | None = None) -> None:
        """End the node; an end without error waits until a second publisher is excluded."""
        if error is None and self._in_doubt():
            self._at_end = True
            self._repeat()
        else:
            self._node.finish(error or self.found)

    def close(self) -> None:
        """End the subscriptions."""
        if self._listener is not None:
            self._listener.destroy_node()

    def _on_timer(self) -> None:
        doubt = self._in_doubt()
        if self._at_end and self.found is None:
            if doubt:
                self._repeat()
            else:
                self._node.finish()

    def _in_doubt(self) -> bool:
        """Return whether the graph lists a second publisher for less than `PROOF_S`."""
        count = self._node.count_publishers
        for topic, name in self._topics.items():
            if count(name) > 1:
                self._listen(topic, name)
            elif topic in self._probes:
                self._listening().destroy_subscription(self._probes.pop(topic).subscription)
        if self.found is not None:
            return False
        return any(probe.listened_s < PROOF_S for probe in self._probes.values())

    def _listen(self, topic: str, name: str) -> None:
        if topic not in self._probes:
            shown = self._node.get_publishers_info_by_topic(name)
            self._probes[topic] = _Probe(self._listening(), name, shown[0].topic_type)
        if self._probes[topic].two_alive() and self.found is None:
            self.found = DdctError(
                f'{topic} has two live publishers, of the nodes '
                f'{publishers_of(self._node, topic)}: stop one, or use another ROS_DOMAIN_ID'
            )
            if self._node.settings.lockstep:
                self._node.finish(self.found)
            else:
                self._node.get_logger().error(f'{self.found}: opening the clutch')
                self._node.every(OPEN_S, lambda: self._node.finish(self.found))

    def _listening(self) -> Node:
        if self._listener is None:
            self._listener = Node(
                'sole_publishers',
                context=self._node.context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
            )
        return self._listener
