# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Write a trajectory as a bag with the same bytes as the recorder's of the same run.

Needs no ROS: the MCAP library builds and serialises the messages from their definitions.
"""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from mcap_ros2._dynamic import generate_dynamic, serialize_dynamic

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.run_info import run_info_order, run_info_topic
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.writer import new_bag
from ddct_plant.bag_file.cdr_numbers import message_serialiser
from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.base.timebase import START_NS, stamp_of_step
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import RUN_INFO, recorded_topics

_ZEROS = b'\x00\x01' + bytes(510)
"""CDR of zeros, longer than any recorded type: decodes as zeros, empty texts and empty lists."""


def write_trajectory(
    trajectory: Trajectory,
    folder: Path,
    name: str,
    custom_data: Mapping[str, str],
    run_info: Mapping[str, Mapping[str, str]],
) -> Path:
    """
    Write `<folder>/<name>_0.mcap` and `metadata.yaml`, and return the path of the former.

    Raise DdctError when the bag cannot be written.
    """
    run = RunFacts.from_custom_data(custom_data).kind(
        two_input=trajectory.two_input,
        sensed=trajectory.sensed,
        shift=trajectory.shift,
        torque_parts=trajectory.torque_parts,
    )
    topics = recorded_topics(run)
    with new_bag(folder, name, topics, custom_data) as bag:
        info_of = _of_topic(RUN_INFO)
        for node in run_info_order(run_info):
            info = info_of(START_NS, run_info[node].items(), name=node)
            bag.write(run_info_topic(node).name, START_NS, info)
        writers = [
            (topic.name, _of_topic(topic), topic.signals_in(run))
            for topic in topics
            if topic.every_tick
        ]
        for k in range(trajectory.steps + 1):
            stamp = stamp_of_step(k)
            for topic_name, serialise, signals in writers:
                values = (trajectory.signals[signal.name][k] for signal in signals)
                bag.write(topic_name, stamp, serialise(stamp, *values))
    return bag.path


def _of_topic(topic: Topic) -> Callable[..., bytes]:
    """Return a function `serialise(stamp_ns, *values, **options)` for messages of a topic."""
    return message_serialiser(topic.kind, topic.writer(plain_class), serialiser(topic.type))


@cache
def plain_class(type_name: str) -> Callable[..., Any]:
    """Return a constructor of messages of a type, called as its ROS class: `new(field=value)`."""
    decode = generate_dynamic(type_name, load_definition(type_name).schema_text)[type_name]

    def new(**values: Any) -> Any:
        message = decode(_ZEROS)
        for name, value in values.items():
            setattr(message, name, value)
        return message

    return new


@cache
def serialiser(type_name: str) -> Callable[[Any], bytes]:
    """Return the CDR serialiser of a message type; its bytes equal those of ROS."""
    return serialize_dynamic(type_name, load_definition(type_name).schema_text)[type_name]
