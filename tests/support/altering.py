# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node that sends altered messages of a topic: on its way to readers, or as a second one."""

import random
from collections import deque
from collections.abc import Callable, Container, Iterable
from typing import Any

from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message

from ddct_plant.bag_file.cdr import stamp_of_cdr
from ddct_plant.base.timebase import PERIOD_NS, START_NS
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_QOS
from ddct_plant.graph.steady_time import SteadyTime
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import TOPICS
from support.in_process_graph import InProcessGraph

Alter = Callable[['AlteringNode', int, bytes], None]
"""Function of the node, the step of a message and its bytes: it sends what shall arrive."""


def topic_named(name: str) -> Topic:
    """Return the topic with this name within the graph."""
    return next(topic for topic in TOPICS if topic.name == name)


def way_to(reader: str, topic: str) -> str:
    """Return the name under which a node receives a topic by way of an altering node."""
    return f'/altered/{reader}/{topic.lstrip("/")}'


def remaps(reader: str, topics: Iterable[str]) -> list[str]:
    """Return the ROS arguments by which the node `reader` receives topics by `way_to` alone."""
    rules = [f'/{topic.lstrip("/")}:={way_to(reader, topic)}' for topic in topics]
    return ['--ros-args', *(part for rule in rules for part in ('-r', rule))]


class AlteringNode(Node):
    """Node that receives a topic under one name, and sends under another what `alter` makes."""

    def __init__(
        self,
        topic: Topic,
        alter: Alter,
        *,
        source: str = '',
        target: str = '',
        name: str = '',
        steady_time: SteadyTime,
        **options: Any,
    ) -> None:
        """Receive the name `source` and send `target`; each is that of the topic if it is ''."""
        target = target or topic.name
        super().__init__(name or f'altering_{target.strip("/").replace("/", "_")}', **options)
        self.topic = topic
        self.steady_time = steady_time
        publisher = self.create_publisher(topic.message_class, target, RECORDER_QOS)
        self.send: Callable[[bytes], None] = publisher.publish

        def receive(cdr: Any) -> None:
            # Not `step_of_stamp`: the message may be one of its own, with a false stamp.
            alter(self, (stamp_of_cdr(cdr) - START_NS) // PERIOD_NS, cdr)

        self.create_subscription(
            topic.message_class, source or topic.name, receive, RECORDER_QOS, raw=True
        )

    def changed(self, cdr: bytes, change: Callable[[Any], object]) -> bytes:
        """Return a message of the topic after `change(message)`."""
        message = deserialize_message(cdr, self.topic.message_class)
        change(message)
        return serialize_message(message)

    def send_later(self, cdr: bytes, delay_s: float) -> None:
        """Send a message after a time in s."""

        def send() -> None:
            timer.cancel()
            self.send(cdr)

        timer = self.steady_time.every(self, delay_s, send)


def add_altering(
    graph: InProcessGraph, topic: str, alter: Alter, *, reader: str = '', **options: Any
) -> AlteringNode:
    """Add a node between a topic and the reader that has `remaps`, or beside its publisher."""
    if reader:
        options['target'] = way_to(reader, topic)
    node = AlteringNode(
        *(topic_named(topic), alter),
        context=graph.context,
        steady_time=graph.steady_time(),
        **options,
    )
    graph.add_other(node)
    return node


def add_silent(graph: InProcessGraph, topic: str, reader: str, steps: Container[int]) -> None:
    """Add the reader of a topic, and before it a node that lets the messages of steps wait."""
    graph.add(reader, cli_args=remaps(reader, [topic]))
    add_altering(graph, topic, Silent(steps, LOOP_QOS.depth), reader=reader)


def changing(change: Callable[[Any], object], from_step: int) -> Alter:
    """Hand messages on, changed from a step on."""

    def alter(node: AlteringNode, step: int, cdr: bytes) -> None:
        node.send(node.changed(cdr, change) if step >= from_step else cdr)

    return alter


def once_more(change: Callable[[Any], object], at_step: int) -> Alter:
    """Send the first message from a step on once more, changed; the others are not touched."""
    sent = False

    def alter(node: AlteringNode, step: int, cdr: bytes) -> None:
        nonlocal sent
        if not sent and step >= at_step:
            sent = True
            node.send(node.changed(cdr, change))

    return alter


class Silent:
    """Let the messages of some steps wait until the next one, as for a process that is stopped."""

    def __init__(self, steps: Container[int], depth: int) -> None:
        """Keep `depth` messages, as a queue of a node does."""
        self._steps = steps
        self._waiting: deque[bytes] = deque(maxlen=depth)

    def __call__(self, node: AlteringNode, step: int, cdr: bytes) -> None:
        """Hand a message on with those that wait, or let it wait."""
        self._waiting.append(cdr)
        if step not in self._steps:
            for each in self._waiting:
                node.send(each)
            self._waiting.clear()


class Repeating:
    """Repeat the last message of a topic at equal times, from a step on."""

    def __init__(self, period_s: float, from_step: int = 0) -> None:
        """Repeat each `period_s`."""
        self._period_s, self._from_step = period_s, from_step
        self._last: bytes | None = None

    def __call__(self, node: AlteringNode, step: int, cdr: bytes) -> None:
        """Keep a message."""
        if step < self._from_step:
            return
        if self._last is None:
            node.steady_time.every(node, self._period_s, lambda: node.send(self._last))
        self._last = cdr


class Lossy:
    """Lose a share of the messages and double another, as a bad network does."""

    def __init__(self, lost: float, doubled: float, seed: str) -> None:
        """Take shares between 0 and 1."""
        self._shares = (lost, doubled)
        self._random = random.Random(seed)
        self.lost = 0
        self.doubled = 0

    def __call__(self, node: AlteringNode, _step: int, cdr: bytes) -> None:
        """Hand a message on, twice, or not."""
        lost, doubled = self._shares
        if self._random.random() < lost:
            self.lost += 1
            return
        node.send(cdr)
        if self._random.random() < doubled:
            self.doubled += 1
            node.send(cdr)
