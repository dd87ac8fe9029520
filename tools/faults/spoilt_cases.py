# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values that no quantity has, and arrays of wrong sizes, from one step on for all readers."""

import math
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from support.altering import add_altering, changing, topic_named
from support.in_process_graph import InProcessGraph
from trajectory_msgs.msg import JointTrajectory

from faults.case import Case, Where, places
from faults.graph_runs import graph_run
from faults.outcome import (
    NO_REPLY,
    NOT_VALID,
    RUNS_ON,
    Observed,
    Stated,
    either,
    named,
    safe_state,
)

NUMBERS: dict[str, Callable[[float], float]] = {
    'value NaN': lambda _: math.nan,
    'value infinity': lambda _: math.inf,
    'value negative': lambda value: -abs(value) - 1.0,
    'value 1e308': lambda _: 1e308,
}
SIZES: dict[str, Callable[[Any], Any]] = {
    'empty array': lambda _: [],
    'short array': lambda array: array[:-1],
    'long array': lambda array: [*array, array[-1]],
}
SPOILT: dict[str, Where] = {
    'value NaN': {
        ('middle', 'lockstep', 1): (
            *('driveline/joint_states', 'clutch/slip_reference'),
            *('clutch/torque_request', 'clutch/torque', 'vehicle/accel'),
        ),
        ('middle', 'lockstep', 2): ('off_going/clutch/torque_request',),
        ('middle', 'realtime', 1): (
            *('driveline/joint_states', 'clutch/torque_request'),
            *('clutch/torque', 'vehicle/accel'),
        ),
    },
    'value infinity': {('middle', 'lockstep', 1): ('clutch/torque',)},
    'value negative': {
        ('middle', 'lockstep', 1): ('clutch/torque_request',),
        ('middle', 'lockstep', 2): ('clutch/handover_share', 'load/holding_torque'),
    },
    'value 1e308': {
        ('middle', 'lockstep', 1): ('clutch/torque_request',),
        ('middle', 'realtime', 2): ('sensors/slip',),
    },
    'empty array': {
        ('middle', 'lockstep', 1): ('driveline/joint_states',),
        ('middle', 'realtime', 1): ('clutch/torque',),
    },
    'short array': {('middle', 'lockstep', 1): ('clutch/torque', 'clutch/slip_reference')},
    'long array': {('middle', 'lockstep', 1): ('clutch/torque', 'driveline/joint_states')},
}
"""Topics by fault: of each type of message, with each rule for a value, one that no node reads."""


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
    for name in ('velocities', 'velocity', 'effort', 'position'):
        if value := list(getattr(holder, name, ())):
            setattr(holder, name, change(value))
            return


def spoilt(spoil: Callable[[Any], Any], topic: str, case: Case, folder: Path) -> Observed:
    """Record a run in which the messages of a topic are changed from a step on."""

    def arrange(graph: InProcessGraph) -> None:
        publisher, name = topic_named(topic).publisher, topic_named(topic).resolved_name
        graph.add(publisher, cli_args=['--ros-args', '-r', f'{name}:=/raw{name}'])
        add_altering(graph, topic, changing(spoil, case.begin), source=f'/raw{name}')

    return graph_run(case, folder, arrange)


TAKEN = Stated(
    'taken as it is: it is a number', lambda seen: not seen.error and seen.steps == seen.planned
)
NO_NUMBER = ('value NaN', 'value infinity', 'value 1e308')
"""Values that no signal has."""
OPENS = {
    **dict.fromkeys(
        ('driveline/joint_states', 'clutch/torque_request', 'sensors/slip'), 'actuator'
    ),
    'clutch/torque': 'driveline',
}
"""By topic of a value that counts as missing in real time, a node that opens its clutch."""


def cases() -> Iterator[Case]:
    """Yield each spoilt number or array of each of its topics."""
    for fault, where in SPOILT.items():
        for name, instant, mode, clutches in places(where):
            refused = _refused(name, mode)
            if fault in NUMBERS:
                spoil = partial(spoil_numbers, NUMBERS[fault])
                stated = refused if fault in NO_NUMBER else either(TAKEN, refused)
            else:
                # In real time they are in the bag too, which then is refused.
                spoil = partial(spoil_array, SIZES[fault])
                stated = either(refused, NOT_VALID)
            yield Case(
                *(fault, name, instant, mode, clutches, stated, partial(spoilt, spoil, name)),
                equipped=clutches == 2,
            )


def _refused(name: str, mode: str) -> Stated:
    """Return what follows from a message that a reader refuses, or that none but a bag takes."""
    if mode == 'lockstep':
        return either(named(name), NOT_VALID)
    if name in OPENS:
        return safe_state(OPENS[name])
    return either(NOT_VALID, RUNS_ON, NO_REPLY)
