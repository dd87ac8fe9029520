# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A stranger in the graph: false stamps, a second publisher, another type, on every topic."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import rclpy
from faults.campaign.case import CLUTCHES, MODES, SAME, Case, Observed, either, named, run_of
from faults.campaign.graph_runs import graph_run
from geometry_msgs.msg import PolygonStamped
from rclpy.clock import Clock, ClockType
from rclpy.context import Context
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.signals import SignalHandlerOptions
from support.in_process_graph import InProcessGraph
from support.patient_clock import PatientClock, realtime_owner

from ddct_plant.base.timebase import PERIOD_NS, step_of_stamp
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_QOS
from ddct_plant.signals.message_kind import set_time, stamp_ns
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import SHIFT_TOPICS, recorded_topics

SHIFTS = {
    'stamp in the past': -30 * PERIOD_NS,
    'stamp in the future': 20 * PERIOD_NS,
    'stamp off the grid': 1,
}
"""By fault the change of a stamp in ns."""
FAR = 3000
"""Factor on these in real time, where the limit of stamps goes with the wall clock: minutes."""
REPEAT_S = 0.02


class Stranger(Node):
    """Node that receives a topic, and from a step on publishes on it once or repeatedly."""

    def __init__(
        self,
        topic: Topic,
        begin: int,
        change: Callable[[Any], None] | None,
        name: str = 'stranger',
        **options: Any,
    ) -> None:
        """Publish the message of step `begin` once, changed, or, without a change, repeatedly."""
        super().__init__(name, **options)
        self._type, self._begin, self._change = topic.message_class, begin, change
        self._publisher = self.create_publisher(self._type, topic.name, RECORDER_QOS)
        self._last: bytes | None = None
        self.create_subscription(self._type, topic.name, self._receive, RECORDER_QOS, raw=True)
        if change is None:
            self.create_timer(
                REPEAT_S, self._repeat, clock=Clock(clock_type=ClockType.STEADY_TIME)
            )

    def _receive(self, cdr: bytes) -> None:
        message = deserialize_message(cdr, self._type)
        if self._begin < 0 or step_of_stamp(stamp_ns(message)) < self._begin:
            return
        if self._change is None:
            self._last = cdr
        else:
            self._begin = -1
            self._change(message)
            self._publisher.publish(serialize_message(message))

    def _repeat(self) -> None:
        if self._last is not None:
            self._publisher.publish(self._last)


def shift_stamp(by_ns: int, message: Any) -> None:
    """Change the stamp of a message."""
    header = getattr(message, 'header', message)
    time = getattr(header, 'stamp', None) or message.clock
    set_time(time, stamp_ns(message) + by_ns)


def false_stamp(by_ns: int, topics: Sequence[Topic], case: Case, folder: Path) -> Observed:
    """Record a run in which one message of each topic comes once more, with another stamp."""

    def arrange(graph: InProcessGraph, _: Observed) -> object:
        change = partial(shift_stamp, by_ns)
        for number, topic in enumerate(topics):
            name = f'stranger{number}'
            stranger = Stranger(topic, case.begin, change, name=name, context=graph.context)
            graph.add_other(stranger)
        if case.mode == 'lockstep':
            return None
        graph.add_all()
        return PatientClock(realtime_owner(graph))

    return graph_run(case, folder, arrange)


def second_publisher(topic: Topic, case: Case, folder: Path) -> Observed:
    """Record a run in which a second node repeats a topic from a step on."""

    def arrange(graph: InProcessGraph, _: Observed) -> None:
        graph.add_other(Stranger(topic, case.begin, None, context=graph.context))

    return graph_run(case, folder, arrange)


def other_type(topic: Topic, case: Case, folder: Path) -> Observed:
    """Record a run in which another node publishes a topic with another type."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        stranger = Node('stranger', context=context)
        stranger.create_publisher(PolygonStamped, topic.name, LOOP_QOS)
        seen = graph_run(case, folder, lambda *_: None)
        stranger.destroy_node()
    finally:
        context.try_shutdown()
    return seen


def topics_of(clutches: int) -> list[Topic]:
    """Return the topics of each tick; with two clutches those that only a shift has."""
    kind = run_of('lockstep', clutches).settings.kind()
    topics = [topic for topic in recorded_topics(kind) if topic.every_tick]
    return topics if clutches == 1 else [topic for topic in topics if topic in SHIFT_TOPICS]


def cases() -> Iterator[Case]:
    """Yield the faults for every topic of a tick, those of a shift in lock-step alone."""
    for clutches in CLUTCHES:
        for topic in topics_of(clutches):
            lockstep = (topic.name, 'middle', 'lockstep', clutches)
            one_of_two = either(SAME, named(topic.name))
            both = named(topic.name, '/stranger')
            for fault, by_ns in SHIFTS.items():
                attempt = partial(false_stamp, by_ns, [topic])
                yield Case(fault, *lockstep, one_of_two, attempt)
            # The middleware may know the type before the name of the node.
            types = named(topic.name, 'PolygonStamped')
            yield Case('another type', *lockstep, types, partial(other_type, topic))
            for mode in MODES if clutches == 1 else MODES[:1]:
                common = (topic.name, 'middle', mode, clutches)
                yield Case('second publisher', *common, both, partial(second_publisher, topic))
    for fault, by_ns in SHIFTS.items():
        every = ('each topic', 'middle', 'realtime', 1)
        yield Case(fault, *every, SAME, partial(false_stamp, FAR * by_ns, topics_of(1)))
