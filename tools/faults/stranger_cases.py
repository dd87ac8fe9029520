# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A stranger in the graph: false stamps, a second publisher, another type."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import rclpy
from geometry_msgs.msg import PolygonStamped
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from support.altering import Repeating, add_altering, once_more, topic_named
from support.in_process_graph import InProcessGraph
from waiting import wait_until

from ddct_plant.base.timebase import PERIOD_NS
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.sole_publishers import publishers_of
from ddct_plant.signals.message_kind import set_time, stamp_ns
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import recorded_topics
from faults.case import Case, Where, places
from faults.graph_runs import graph_run
from faults.outcome import NO_REPLY, REFUSED, RUNS_ON, SAME, Observed, Stated, either, named

SHIFTS = {
    'stamp in the past': -30 * PERIOD_NS,
    'stamp in the future': 20 * PERIOD_NS,
    'stamp off the grid': 1,
}
"""By fault the change of a stamp in ns."""
REPEAT_S = 0.02
FALSELY_STAMPED: dict[str, Where] = {
    'stamp in the past': {('middle', 'lockstep', 1): ('/clock', 'clutch/torque')},
    'stamp in the future': {
        ('middle', 'lockstep', 1): ('/clock', 'clutch/torque', 'controller/status'),
    },
    'stamp off the grid': {
        ('middle', 'lockstep', 1): ('clutch/torque', 'recorder/ack'),
        ('middle', 'lockstep', 2): ('clutch/handover_share',),
    },
}
"""Topics that owner of time, joins and recorder read."""
TWICE_PUBLISHED: Where = {
    ('middle', 'lockstep', 1): ('/clock', 'clutch/torque', 'controller/status'),
    ('middle', 'realtime', 1): ('/clock', 'clutch/torque_request'),
}
OF_ANOTHER_TYPE: Where = {
    ('start', 'lockstep', 1): ('clutch/torque', 'controller/status', 'run_info'),
    ('start', 'realtime', 1): ('load/torque', '/diagnostics'),
}
"""Topics that somebody waits for, that only the recorder reads, and reports."""


def shift_stamp(by_ns: int, message: Any) -> None:
    """Change the stamp of a message."""
    header = getattr(message, 'header', message)
    time = getattr(header, 'stamp', None) or message.clock
    set_time(time, stamp_ns(message) + by_ns)


def false_stamp(by_ns: int, topics: Sequence[str], case: Case, folder: Path) -> Observed:
    """Record a run in which one message of each topic comes once more, with another stamp."""

    def arrange(graph: InProcessGraph) -> None:
        for number, topic in enumerate(topics):
            alter = once_more(partial(shift_stamp, by_ns), case.begin)
            add_altering(graph, topic, alter, name=f'stranger{number}')

    return graph_run(case, folder, arrange)


def second_publisher(topic: str, case: Case, folder: Path) -> Observed:
    """Record a run in which a second node repeats a topic from a step on."""

    def arrange(graph: InProcessGraph) -> None:
        add_altering(graph, topic, Repeating(REPEAT_S, case.begin), name='stranger')

    return graph_run(case, folder, arrange)


def other_type(topic: str, case: Case, folder: Path) -> Observed:
    """Record a run in which another node publishes a topic with another type."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        stranger = Node('stranger', context=context)
        stranger.create_publisher(PolygonStamped, topic, LOOP_QOS)

        def found(graph: InProcessGraph) -> None:
            wait_until(lambda: '/stranger' in publishers_of(graph.watch, topic), 'its name')

        seen = graph_run(case, folder, found)
        stranger.destroy_node()
    finally:
        context.try_shutdown()
    return seen


def topics_of_a_tick(*, ticks: bool) -> list[str]:
    """Return the topics of a run with one clutch that carry ticks, or replies to them."""
    every_tick = [topic for topic in recorded_topics(RunKind()) if topic.every_tick]
    return [topic.name for topic in every_tick if topic.is_tick == ticks]


def cases() -> Iterator[Case]:
    """Yield each fault of each of its topics; false stamps in real time for many at once."""
    for fault, by_ns in SHIFTS.items():
        for name, instant, mode, clutches in places(FALSELY_STAMPED[fault]):
            attempt = partial(false_stamp, by_ns, [name])
            yield _case(fault, name, instant, mode, clutches, either(SAME, named(name)), attempt)
        for target, ticks in (('each reply', False), ('each tick', True)):
            # Nodes go on from a tick in the future, and do not answer those before it.
            ahead = ticks and fault == 'stamp in the future'
            attempt = partial(false_stamp, by_ns, topics_of_a_tick(ticks=ticks))
            stated = either(RUNS_ON, REFUSED, NO_REPLY) if ahead else SAME
            yield _case(fault, target, 'middle', 'realtime', 1, stated, attempt)
    for name, instant, mode, clutches in places(TWICE_PUBLISHED):
        attempt = partial(second_publisher, name)
        stated = named(name, '/stranger')
        yield _case('second publisher', name, instant, mode, clutches, stated, attempt)
    for name, instant, mode, clutches in places(OF_ANOTHER_TYPE):
        # The middleware may know the type before the name of the node. No node waits for a
        # report, and none receives it with another type.
        harmless = SAME if mode == 'lockstep' else RUNS_ON
        stated = named(name, 'PolygonStamped') if topic_named(name).every_tick else harmless
        attempt = partial(other_type, name)
        yield _case('another type', name, instant, mode, clutches, stated, attempt)


def _case(
    fault: str,
    target: str,
    instant: str,
    mode: str,
    clutches: int,
    stated: Stated,
    attempt: Callable[[Case, Path], Observed],
) -> Case:
    equipped = clutches == 2
    return Case(fault, target, instant, mode, clutches, stated, attempt, equipped=equipped)
