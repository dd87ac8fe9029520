# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read signals of earlier bags that have topics of their own now (`Topic.later`).

Up to version 0.1 the parts of the torque request were texts in `controller/status`. The flag of a
repeated sample was the frame 'held' in the header, or the effort of a measured joint.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from ddct_plant.signals.tables.sensors import ENGINE_SENSOR_STATUS, SENSOR_STATUS
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    CONTROLLER_STATUS,
    SENSED_ENGINE_TORQUE,
    SENSED_JOINT_STATES,
    SENSED_SLIP,
    SENSED_VEHICLE_SPEED,
    TORQUE_PARTS,
)

Messages = Mapping[str, Sequence[tuple[int, Any]]]
"""Pairs of stamp in ns and message, by resolved topic name."""
Values = dict[int, tuple[Any, ...]]
"""Values of a topic's signals by stamp in ns."""

EARLIER_TOPICS = (
    CONTROLLER_STATUS,
    SENSED_JOINT_STATES,
    SENSED_SLIP,
    SENSED_VEHICLE_SPEED,
    SENSED_ENGINE_TORQUE,
)
"""Topics whose messages have the signals of later topics."""
_HELD = 'held'
_PARTS = ('open_loop_torque_n_m', 'closed_loop_torque_n_m')
_CLOSING = 'closing_torque_n_m'


def earlier_values(topic: Topic, messages: Messages) -> Values:
    """
    Return the values of a topic with `later`, from the messages of a bag without the topic.

    They are empty where the bag lacks an optional topic and has nothing in its place.
    Raise LookupError, AttributeError or ValueError where a message lacks one.
    """
    return _READERS[topic](messages)


def _torque_parts(messages: Messages) -> Values:
    values: Values = {}
    for stamp, message in _of(CONTROLLER_STATUS, messages):
        pairs = {pair.key: pair.value for pair in message.status[0].values}
        # Nodes of third parties have never had to publish the parts.
        if any(key in pairs for key in _PARTS):
            parts = [float(pairs[key]) for key in _PARTS]
            values[stamp] = (*parts, float(pairs.get(_CLOSING, '0')))
    return values


def _speed_flags(messages: Messages) -> Values:
    slip, vehicle = (dict(_of(each, messages)) for each in (SENSED_SLIP, SENSED_VEHICLE_SPEED))
    return {
        stamp: (list(joints.effort), _flag(slip[stamp]), _flag(vehicle[stamp]))
        for stamp, joints in _of(SENSED_JOINT_STATES, messages)
    }


def _torque_flags(messages: Messages) -> Values:
    return {stamp: (_flag(message),) for stamp, message in _of(SENSED_ENGINE_TORQUE, messages)}


def _of(topic: Topic, messages: Messages) -> Sequence[tuple[int, Any]]:
    return messages.get(topic.resolved_name, ())


def _flag(message: Any) -> float:
    return float(message.header.frame_id == _HELD)


_READERS = {
    TORQUE_PARTS: _torque_parts,
    SENSOR_STATUS: _speed_flags,
    ENGINE_SENSOR_STATUS: _torque_flags,
}
"""Function that reads the signals of each topic with `later`."""
