# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Check that each topic of the loop has one live publisher."""

from collections.abc import Callable

from rclpy.node import Node
from rclpy.subscription import Subscription

from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.signals.message_kind import ros_class
from ddct_plant.signals.topics import TOPICS
from ddct_plant.ticks.sequence import SequenceWatch

CHECK_S = 0.2
"""Period in s of the check, and of repeated requests for the last replies at a doubtful end."""
PROOF_S = 1.0
"""
Time in s with messages that excludes a second live publisher of a topic that the graph lists.

Between two checks at most `CHECK_S` counts, and nothing where no message arrived: neither a
process that could not run nor the wait for the first tick excludes anything.
"""
SILENCE_S = 5.0
"""Time in s without any message, though replies are requested, after which a run may end too."""
OPEN_S = 1.0
"""Time in s that a real-time run goes on with a second publisher, with an open clutch."""
NAMING_S = 2.0
"""
Time in s for which an error in lock-step waits for the name of a node.

Names come after topics. In real time the clutch opens at once, and the error that ends the node
has the names: it comes `OPEN_S` later, or at the end of the run as soon as they are known.
"""
_UNKNOWN = '_NODE_NAME_UNKNOWN_'
"""Name in rmw of a node whose topics are known before its name."""
_UNNAMED = 'one that the middleware has not named yet'


def publishers_of(node: Node, topic: str) -> str:
    """Return the names of all publishers of a topic of `node` in the ROS graph."""
    shown = node.get_publishers_info_by_topic(node.resolve_topic_name(topic))
    names = sorted(f'{each.node_namespace.rstrip("/")}/{each.node_name}' for each in shown)
    return ' and '.join(_UNNAMED if _UNKNOWN in name else name for name in names)


class _Probe:
    """Reader of the sequence numbers of one topic, which an executor does not pass on."""

    def __init__(self, node: Node, topic: str, type_name: str, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._with_messages_s = 0.0
        self._silence_s = 0.0
        self._checked_at = clock()
        self.subscription: Subscription = node.create_subscription(
            ros_class(type_name), topic, lambda _: None, RECORDER_QOS, raw=True
        )
        self._watch = SequenceWatch()

    @property
    def excludes_two(self) -> bool:
        """Whether two live publishers would have been detected by now."""
        return self._with_messages_s >= PROOF_S or self._silence_s >= SILENCE_S

    def two_alive(self) -> bool:
        """Take the messages that have arrived; return whether two publishers sent them."""
        now = self._clock()
        passed_s = min(now - self._checked_at, CHECK_S)
        self._checked_at = now
        self._silence_s += passed_s
        handle, message_type = self.subscription.handle, self.subscription.msg_type
        while (taken := handle.take_message(message_type, True)) is not None:
            self._watch.note(taken[1]['publication_sequence_number'])
            self._silence_s = 0.0
        if not self._silence_s:
            self._with_messages_s += passed_s
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
        self._clock = node.steady_time.monotonic
        self.found: DdctError | None = None
        """Error that names the second publisher; None before one is found."""
        self._topics = {
            topic.name: node.resolve_topic_name(topic.name) for topic in TOPICS if topic.every_tick
        }
        self._types = {topic.name: topic.type for topic in TOPICS}
        self._repeat = repeat
        self._listener: Node | None = None
        self._probes: dict[str, _Probe] = {}
        self._at_end = False
        self._proved_at: float | None = None
        self._named: Callable[[], DdctError | None] = lambda: None
        """Return `found` with the names that are known by then."""
        node.every(CHECK_S, self._on_timer)

    def finish(self, error: DdctError | None = None) -> None:
        """End the node; one without error waits until a second publisher is excluded or named."""
        if error is None and self._in_doubt():
            self._at_end = True
            if self.found is None:
                self._repeat()
        else:
            self._node.finish(error or self._named())

    def close(self) -> None:
        """End the check and its subscriptions; timers of the node may still run."""
        self._topics = {}
        self._probes.clear()
        if self._listener is not None:
            self._listener.destroy_node()

    def _on_timer(self) -> None:
        if self._at_end:
            self.finish()
        else:
            self._in_doubt()

    def _in_doubt(self) -> bool:
        """Return whether a second publisher is neither excluded nor proved and named."""
        count = self._node.count_publishers
        proved = {}
        for topic, name in self._topics.items():
            if count(name) > 1:
                if complaint := self._listen(topic, name):
                    proved[topic] = complaint
            elif topic in self._probes:
                self._listening().destroy_subscription(self._probes.pop(topic).subscription)
        if proved and self.found is None:
            self._end(*next(iter(proved.items())))
        if self.found is not None:
            return _UNNAMED in str(self._named())
        return bool(proved) or not all(each.excludes_two for each in self._probes.values())

    def _listen(self, topic: str, name: str) -> str | None:
        """Return what is wrong with the publishers of a topic, None before it is proved."""
        if topic not in self._probes:
            shown = self._node.get_publishers_info_by_topic(name)
            ours = self._types[topic]
            if other := sorted({each.topic_type for each in shown} - {ours}):
                return f'is published as {other[0]} too, not as {ours} alone, by'
            self._probes[topic] = _Probe(self._listening(), name, ours, self._clock)
        return 'has two live publishers, of' if self._probes[topic].two_alive() else None

    def _end(self, topic: str, complaint: str) -> None:
        """End the node, in real time with an open clutch before that."""
        lockstep, now = self._node.known.lockstep, self._clock()
        error = self._error(topic, complaint)
        if self._proved_at is None:
            self._proved_at = now
        unnamed = _UNNAMED in str(error)
        if lockstep and unnamed and now - self._proved_at < NAMING_S:
            return
        self.found = error
        self._named = lambda: self._error(topic, complaint) if unnamed else error
        if lockstep:
            self._node.finish(error)
        else:
            self._node.get_logger().error(f'{error}: opening the clutch')
            self._node.every(OPEN_S, lambda: self._node.finish(self._named()))

    def _error(self, topic: str, complaint: str) -> DdctError:
        """Return the error with the names that the middleware knows by now."""
        return DdctError(
            f'{topic} {complaint} the nodes {publishers_of(self._node, topic)}: stop one, or use'
            ' another ROS_DOMAIN_ID',
            key=topic,
        )

    def _listening(self) -> Node:
        if self._listener is None:
            self._listener = Node(
                'sole_publishers',
                namespace=self._node.get_namespace(),
                context=self._node.context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
            )
        return self._listener
