# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A stranger in the graph: false stamps, a second publisher, another type, on every topic."""

from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from itertools import product
from pathlib import Path
from typing import Any

import rclpy
from faults.campaign.case import CLUTCHES, MODES, Case, run_of
from faults.campaign.graph_runs import graph_run
from faults.campaign.outcome import RUNS_ON, SAME, Observed, either, named
from geometry_msgs.msg import PolygonStamped
from rclpy.clock import Clock, ClockType
from rclpy.context import Context
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.signals import SignalHandlerOptions
from support.in_process_graph import InProcessGraph

from ddct_plant.base.timebase import PERIOD_NS, step_of_stamp
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_QOS
from ddct_plant.signals.message_kind import set_time, stamp_ns
from ddct_plant.signals.signal import RunKind
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import recorded_topics

SHIFTS = {
    'stamp in the past': -30 * PERIOD_NS,
    'stamp in the future': 20 * PERIOD_NS,
    'stamp off the grid': 1,
}
"""By fault the change of a stamp in ns."""
FAR = 3000
"""Factor on these in real time, where the limit of stamps goes with the wall clock: minutes."""
REPEAT_S = 0.02
PLAIN = RunKind()
"""Run without anything optional."""


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

    def arrange(graph: InProcessGraph) -> None:
        change = partial(shift_stamp, by_ns)
        for number, topic in enumerate(topics):
            name = f'stranger{number}'
            stranger = Stranger(topic, case.begin, change, name=name, context=graph.context)
            graph.add_other(stranger)

    return graph_run(case, folder, arrange, case.steps)


def second_publisher(topic: Topic, case: Case, folder: Path) -> Observed:
    """Record a run in which a second node repeats a topic from a step on."""

    def arrange(graph: InProcessGraph) -> None:
        graph.add_other(Stranger(topic, case.begin, None, context=graph.context))

    return graph_run(case, folder, arrange)


def other_type(topic: Topic, case: Case, folder: Path) -> Observed:
    """Record a run in which another node publishes a topic with another type."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        stranger = Node('stranger', context=context)
        stranger.create_publisher(PolygonStamped, topic.name, LOOP_QOS)
        seen = graph_run(case, folder, lambda _: None)
        stranger.destroy_node()
    finally:
        context.try_shutdown()
    return seen


@cache
def topics_of(clutches: int) -> tuple[Topic, ...]:
    """Return the topics of each tick; with two clutches those that one clutch lacks."""
    if clutches == 1:
        return _ticked(run_of('lockstep', 1).settings.kind())
    every = _ticked(run_of('lockstep', 2, equipped=True).settings.kind(two_input=True))
    return tuple(topic for topic in every if topic not in topics_of(1))


def _ticked(kind: RunKind) -> tuple[Topic, ...]:
    return tuple(topic for topic in recorded_topics(kind) if topic.every_tick)


def cases() -> Iterator[Case]:
    """Yield the faults for every topic of a tick; false stamps in real time for all at once."""
    for clutches, mode in product(CLUTCHES, MODES):
        make = partial(Case, mode=mode, clutches=clutches, equipped=clutches == 2)
        for topic in topics_of(clutches):
            if mode == 'lockstep':
                one_of_two = either(SAME, named(topic.name))
                for fault, by_ns in SHIFTS.items():
                    attempt = partial(false_stamp, by_ns, [topic])
                    yield make(fault, topic.name, 'middle', stated=one_of_two, attempt=attempt)
            both = named(topic.name, '/stranger')
            second = partial(second_publisher, topic)
            yield make('second publisher', topic.name, 'middle', stated=both, attempt=second)
        if mode == 'realtime':
            for fault, by_ns in SHIFTS.items():
                attempt = partial(false_stamp, FAR * by_ns, topics_of(clutches))
                yield make(fault, 'each topic', 'middle', stated=SAME, attempt=attempt)
        for topic in (*topics_of(clutches), *_reports(clutches, mode)):
            # The middleware may know the type before the name of the node. No node waits for a
            # report, and none receives it with another type.
            harmless = SAME if mode == 'lockstep' else RUNS_ON
            stated = named(topic.name, 'PolygonStamped') if topic.every_tick else harmless
            attempt = partial(other_type, topic)
            yield make('another type', topic.name, 'start', stated=stated, attempt=attempt)


def _reports(clutches: int, mode: str) -> list[Topic]:
    """Return the topics without a message per tick that a run has, once for all runs."""
    kind = run_of(mode, clutches).settings.kind()
    reports = [topic for topic in recorded_topics(kind) if not topic.every_tick]
    return reports if clutches == 1 else [each for each in reports if not each.in_run(PLAIN)]
