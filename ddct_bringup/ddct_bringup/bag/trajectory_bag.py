# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Write a trajectory as a bag with the same bytes as the recorder's of the same run.

Needs no ROS: the messages are built and serialised from their definitions.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.bag.run_info import run_info_order, run_info_topic
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.writer import BagWriter
from ddct_plant.bag_file.message_definitions import encode, message_class
from ddct_plant.bag_file.number_columns import NumberColumns
from ddct_plant.base.timebase import START_NS, stamp_of_step
from ddct_plant.scenario.recorded_settings import settings_of_bag
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import RUN_INFO, recorded_topics

_TOGETHER = 512
"""Number of messages of a topic that are serialised at once; it bounds the memory of a run."""


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
    known = settings_of_bag(custom_data).known
    run = RunKind(
        lockstep=known.mode == 'lockstep',
        two_input=trajectory.two_input,
        clutch=known.clutch,
        sensed=trajectory.sensed,
        shift=trajectory.shift,
        torque_parts=trajectory.torque_parts,
    )
    topics = recorded_topics(run)
    stamps = np.array([stamp_of_step(k) for k in range(trajectory.steps + 1)])
    with BagWriter(folder, name, topics, custom_data) as bag:
        info = RUN_INFO.writer(message_class)
        for node in run_info_order(run_info):
            message = info(START_NS, run_info[node].items(), name=node)
            bag.write(run_info_topic(node).name, START_NS, encode(message))
        ticks = {
            topic: _messages(
                topic, stamps, [trajectory.signals[each.name] for each in topic.signals_in(run)]
            )
            for topic in topics
            if topic.every_tick
        }
        for stamp, *messages in zip(stamps.tolist(), *ticks.values(), strict=True):
            bag.write_tick(stamp, [*ticks], messages)
    return bag.path


def _messages(topic: Topic, stamps: np.ndarray, columns: Sequence[Any]) -> Iterator[bytes]:
    """Yield the messages of a topic with (n,) stamps in ns and columns of n values by signal."""
    if not topic.kind.numbers_alone:
        write = topic.writer(message_class)
        for stamp, *values in zip(stamps.tolist(), *columns, strict=True):
            yield encode(write(stamp, *values))
        return
    layout = _layout(topic, tuple(np.shape(column)[1:] for column in columns))
    for first in range(0, len(stamps), _TOGETHER):
        part = slice(first, first + _TOGETHER)
        yield from layout.encode(stamps[part], [column[part] for column in columns])


@lru_cache(maxsize=64)
def _layout(topic: Topic, shapes: tuple[tuple[int, ...], ...]) -> NumberColumns:
    """Return the layout of the messages of a topic, whose signals have values of these shapes."""
    return NumberColumns(topic, [np.zeros(shape)[()] for shape in shapes])
