# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The graph's own joins and replies on a network that a test delivers by hand; no ROS."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple
from zlib import crc32

from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.ticks.join import StampJoin
from ddct_plant.ticks.replies import StampReplies

ACK = 'recorder/ack'
DRIVELINE, RECORDER = 'driveline', 'recorder'


class Wires(NamedTuple):
    """Topics that a node joins, the trigger first, and those that it answers with."""

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


@dataclass(frozen=True)
class Wiring:
    """Who reads and answers what in a run with one clutch or with two."""

    ticks: tuple[str, ...]
    nodes: Mapping[str, Wires]
    torques: tuple[str, ...]
    clutches: tuple[str, ...]

    def readers(self, topic: str) -> list[str]:
        """Return the nodes that read a topic."""
        readers = [name for name, wires in self.nodes.items() if topic in wires.inputs]
        return readers + [DRIVELINE] * (topic in self.torques or topic == ACK)

    def with_recorder(self) -> 'Wiring':
        """Return the wiring with a recorder that joins every topic and acknowledges the tick."""
        replies = [topic for wires in self.nodes.values() for topic in wires.outputs]
        recorder = Wires((*self.ticks, *replies), (ACK,))
        return replace(self, nodes={**self.nodes, RECORDER: recorder})


_TICKS = ('joints', 'slip', 'twist')
_ONE = {
    'engine': Wires(('joints',), ('engine/torque',)),
    'load': Wires(('twist',), ('load/torque',)),
    'reference': Wires(('slip',), ('reference',)),
    'controller': Wires(('joints', 'twist', 'engine/torque', 'reference'), ('request',)),
    'actuator': Wires(('request',), ('actuator/torque',)),
    'clutch': Wires(('actuator/torque',), ('clutch/torque',)),
}
_SHIFT_TICKS = (*_TICKS, 'phase', 'off/slip', 'off/phase')
_SHIFT = {
    'demand': Wires(('joints',), ('demand',)),
    'handover': Wires(
        ('joints', 'slip', 'twist', 'demand', 'off/slip'), ('cut', 'share', 'off/request')
    ),
    'engine': Wires(('joints', 'cut'), ('engine/torque',)),
    'load': Wires(('twist',), ('load/torque', 'holding')),
    'reference': Wires(('slip', 'share'), ('reference',)),
    'controller': Wires(('joints', 'twist', 'engine/torque', 'reference', 'share'), ('request',)),
    'actuator': Wires(('request',), ('actuator/torque',)),
    'clutch': Wires(('actuator/torque', 'slip', 'phase'), ('clutch/torque',)),
    'off/actuator': Wires(('off/request',), ('off/actuator/torque',)),
    'off/clutch': Wires(('off/actuator/torque', 'off/slip', 'off/phase'), ('off/torque',)),
}
ONE_CLUTCH = Wiring(
    _TICKS,
    _ONE,
    ('engine/torque', 'load/torque', 'clutch/torque'),
    ('clutch/torque',),
)
TWO_CLUTCHES = Wiring(
    _SHIFT_TICKS,
    _SHIFT,
    ('engine/torque', 'load/torque', 'holding', 'clutch/torque', 'off/torque'),
    ('clutch/torque', 'off/torque'),
)
"""`demand` is the part of the engine that publishes its demand at once."""


def digest(*facts: Any) -> float:
    """Return a number in [0, 100) that depends on all of the given facts."""
    return crc32(repr(facts).encode()) / 2**32 * 100.0


def answer_of(topic: str, step: int, inputs: Mapping[str, float]) -> float:
    """Return the one right value of a reply, which depends on its step and on all inputs."""
    return digest(topic, step, sorted(inputs.items()))


class Message(NamedTuple):
    """Message on its way to one reader."""

    reader: str
    topic: str
    step: int
    value: float


@dataclass
class Network:
    """Followers of the real classes, and the messages on their way; no order is kept."""

    wiring: Wiring
    to_driveline: Callable[[Message], None]
    allow_gaps: bool
    on_answer: Callable[[str, int, Mapping[str, float]], None]
    """Called with node, step and inputs of each computed reply."""
    on_way: list[Message] = field(default_factory=list)
    arrived: list[Message] = field(default_factory=list)
    """Messages that have arrived once, which may come again."""
    disputes: list[tuple[str, str, int]] = field(default_factory=list)
    """Node, topic and stamp of each trigger that came again with other values."""

    def __post_init__(self) -> None:
        self.joins: dict[str, StampJoin] = {}
        self._replies: dict[str, StampReplies] = {}
        for name in self.wiring.nodes:
            self.start(name)

    def start(self, name: str) -> None:
        """Start a node, again if it was there: it has no memory then."""
        wires = self.wiring.nodes[name]
        kept: list[tuple[int, dict[str, float]]] = []

        def answer(step: int, stamp: int, inputs: dict[str, Any]) -> None:
            assert stamp == stamp_of_step(step)
            self.on_answer(name, step, inputs)
            kept[:] = [(step, inputs)]

        def publish() -> None:
            ((step, inputs),) = kept
            for topic in wires.outputs:
                self.publish(topic, step, answer_of(topic, step, inputs))

        def dispute(topic: str, stamp: int) -> None:
            self.disputes.append((name, topic, stamp))

        self.joins[name] = StampJoin(wires.inputs, allow_gaps=self.allow_gaps)
        self._replies[name] = StampReplies(self.joins[name], answer, publish, dispute)

    def publish(self, topic: str, step: int, value: float) -> None:
        """Send a message to each of its readers."""
        for reader in self.wiring.readers(topic):
            self.on_way.append(Message(reader, topic, step, value))

    def deliver(self, message: Message) -> None:
        """Let a reader receive a message now; raise the errors of the reader."""
        if message.reader == DRIVELINE:
            self.to_driveline(message)
        else:
            self._replies[message.reader].receive(
                message.topic, stamp_of_step(message.step), message.value
            )

    def take(self, index: int) -> Message:
        """Return the message at `index` modulo their number, and take it off its way."""
        message = self.on_way.pop(index % len(self.on_way))
        self.arrived.append(message)
        return message
