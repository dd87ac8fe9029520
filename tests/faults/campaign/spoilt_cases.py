# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values that no quantity has, and arrays of wrong sizes, from one step on for all readers."""

import math
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from faults.campaign.case import CLUTCHES, MODES, RUNS_ON, Case, Observed, Stated, either, named
from faults.campaign.graph_runs import graph_run
from faults.campaign.stranger_cases import topics_of
from rclpy.node import Node
from sensor_msgs.msg import JointState
from support.in_process_graph import InProcessGraph
from trajectory_msgs.msg import JointTrajectory

from ddct_bringup.processes.graph_nodes import nodes_of
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topic import Topic

TEN_MB = 1_250_000
"""Length of an array of doubles with ten megabytes."""
NUMBERS: dict[str, Callable[[float], float]] = {
    'NaN': lambda _: math.nan,
    'infinity': lambda _: math.inf,
    'negative': lambda value: -abs(value) - 1.0,
    '1e308': lambda _: 1e308,
}
SIZES: dict[str, Callable[[Any], Any]] = {
    'empty array': lambda _: [],
    'short array': lambda array: array[:-1],
    'long array': lambda array: [*array, array[-1]],
    '10 MB array': lambda array: [array[0]] * TEN_MB,
}


class Spoiler(Node):
    """Node between the publisher of a topic and all of its readers."""

    def __init__(self, topic: Topic, begin: int, spoil: Callable[[Any], Any], **options: Any):
        """Forward `topic`; `spoil` returns the changed message from step `begin` on."""
        super().__init__('spoiler', **options)
        self._begin, self._spoil = begin, spoil
        self._publisher = self.create_publisher(topic.message_class, topic.name, RECORDER_QOS)
        self.create_subscription(topic.message_class, raw_name(topic), self._pass, RECORDER_QOS)

    def _pass(self, message: Any) -> None:
        if step_of_stamp(stamp_ns(message)) >= self._begin:
            self._spoil(message)
        self._publisher.publish(message)


def raw_name(topic: Topic) -> str:
    """Return the name under which the publisher of a topic publishes it here."""
    return f'/raw{topic.resolved_name}'


def spoil_numbers(change: Callable[[float], float], message: Any) -> None:
    """Change every floating-point number of a message."""
    for name, kind in message.get_fields_and_field_types().items():
        value = getattr(message, name)
        if kind == 'double':
            setattr(message, name, change(value))
        elif kind == 'sequence<double>':
            setattr(message, name, [change(each) for each in value])
        elif kind.startswith('sequence<'):
            for each in value:
                if hasattr(each, 'get_fields_and_field_types'):
                    spoil_numbers(change, each)
        elif hasattr(value, 'get_fields_and_field_types'):
            spoil_numbers(change, value)


def spoil_array(change: Callable[[Any], Any], message: Any) -> None:
    """Change the size of the first array of numbers of a message."""
    holder = message.points[0] if isinstance(message, JointTrajectory) else message
    for name in ('velocities', 'effort', 'velocity', 'position'):
        if value := list(getattr(holder, name, ())):
            setattr(holder, name, change(value))
            return


def spoilt(
    spoil: Callable[[Any], Any], publisher: str, topic: Topic, case: Case, folder: Path
) -> Observed:
    """Record a run in which the messages of a topic are changed from a step on."""

    def arrange(graph: InProcessGraph, _: Observed) -> None:
        remap = ['--ros-args', '-r', f'{topic.resolved_name}:={raw_name(topic)}']
        graph.add(publisher, cli_args=remap)
        graph.add_other(Spoiler(topic, case.begin, spoil, context=graph.context))

    return graph_run(case, folder, arrange)


ANY_ERROR = Stated(
    'an error of one line',
    lambda seen: bool(seen.error) and 'traceback' not in seen.error and '\n' not in seen.error,
)
NOT_VALID = Stated(
    'a recording that is not valid', lambda seen: not seen.error and not seen.complete
)
TAKEN = Stated(
    'taken as it is: it is a number', lambda seen: not seen.error and seen.steps == seen.planned
)


def cases() -> Iterator[Case]:
    """Yield spoilt numbers and arrays of each topic; all kinds in lock-step with one clutch."""
    for clutches in CLUTCHES:
        publishers = {spec.path for spec in nodes_of(shift=clutches == 2)}
        for mode in MODES if clutches == 1 else MODES[:1]:
            for topic in topics_of(clutches):
                publisher = topic.publisher
                assert publisher in publishers, publisher
                common = (topic.name, 'middle', mode, clutches)
                bad = either(named(topic.name), *_without_error(mode))
                if not _has_numbers(topic):
                    continue
                whole = (mode, clutches) == ('lockstep', 1)
                for what, change in list(NUMBERS.items())[: None if whole else 1]:
                    spoil = partial(spoil_numbers, change)
                    stated = bad if not math.isfinite(change(1.0)) else either(TAKEN, ANY_ERROR)
                    attempt = partial(spoilt, spoil, publisher, topic)
                    yield Case(f'value {what}', *common, stated, attempt)
                if topic.message_class in (JointTrajectory, JointState):
                    for what, change_array in list(SIZES.items())[0 if whole else -1 :]:
                        spoil = partial(spoil_array, change_array)
                        attempt = partial(spoilt, spoil, publisher, topic)
                        yield Case(what, *common, bad, attempt)


def _without_error(mode: str) -> list[Stated]:
    return [NOT_VALID] if mode == 'lockstep' else [NOT_VALID, RUNS_ON, named('no ')]


def _has_numbers(topic: Topic) -> bool:
    return topic.type.startswith(('geometry_msgs', 'sensor_msgs', 'trajectory_msgs'))
