# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals of a recorded bag as a car's own sensors would measure them."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ddct_bringup.logs.columns import QUANTITIES
from ddct_plant.bag_file.decoding import TopicColumns, read_columns
from ddct_plant.bag_file.records import BagRecords, read_records
from ddct_plant.base.clutch_kinds import LINEAR, STICK_SLIP
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_NS, START_NS, SUBSTEP_NS, SUBSTEPS
from ddct_plant.files.input_file import located
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import (
    CLUTCH_PHASE,
    CLUTCH_TORQUE,
    ENGINE_TORQUE,
    JOINT_STATES,
    VEHICLE_ACCEL,
    VEHICLE_SPEED,
    quantities,
)

_TOPICS = (JOINT_STATES, ENGINE_TORQUE, CLUTCH_TORQUE, CLUTCH_PHASE, VEHICLE_SPEED, VEHICLE_ACCEL)
_MEASURED = (
    *('engine_speed', 'shaft_speed', 'wheel_speed'),
    *('engine_torque', 'clutch_torque', 'vehicle_speed', 'vehicle_accel'),
)
"""Quantities that are read: those that a car can measure, without C_load."""


def read_bag_signals(bag: Path) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """
    Return the times in s of the MCAP file of a bag, (n,), and by quantity its values, (n,).

    Speeds, C_m, V_x and A_x are sampled every 10 ms. C_f is sampled every 1 ms with the linear
    clutch; with the stick-slip clutch it is the transmitted torque just before each tick. C_load
    is omitted, because no car measures it. In a run with sensors the signals are the true ones,
    too. An unfinished bag gives those before its end.
    Raise DdctError for a file that is no recording of this project or is damaged, and for a value
    that is missing, given twice or not finite.
    """
    records = read_records(bag)
    with located(str(bag)):
        found = _ticks(records)
        times = {name: _stamps(found, name) for name in _MEASURED}
        values = {name: _values(found, name) for name in _MEASURED}
        if CLUTCH_PHASE not in found:
            times['clutch_torque'], values['clutch_torque'] = _within_periods(
                found[CLUTCH_TORQUE], int(found[JOINT_STATES].stamps.max())
            )
        for name, column in values.items():
            if not np.isfinite(column).all():
                raise DdctError(f'{name} has a value that is not finite: record the run again')
    stamps = np.unique(np.concatenate(list(times.values())))
    signals = {}
    for name in _MEASURED:
        signals[name] = np.full(len(stamps), np.nan)
        signals[name][np.searchsorted(stamps, times[name])] = values[name]
    return (stamps - START_NS) / 1e9, signals


def _stamps(found: Mapping[Topic, TopicColumns], name: str) -> np.ndarray:
    return found[_topic_of(name)].stamps


def _values(found: Mapping[Topic, TopicColumns], name: str) -> np.ndarray:
    """Return a quantity at the stamps of its topic, (n,)."""
    signal, index = quantities()[QUANTITIES[name].signal]
    topic = _topic_of(name)
    column = np.asarray(found[topic].values[topic.signals.index(signal)])
    return column if index is None else column[:, index]


def _topic_of(name: str) -> Topic:
    signal, _ = quantities()[QUANTITIES[name].signal]
    return next(topic for topic in _TOPICS if signal in topic.signals)


def _within_periods(torques: TopicColumns, last: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the stamps in ns and the values of a torque every 1 ms, up to the stamp `last`."""
    stamps = np.add.outer(torques.stamps, SUBSTEP_NS * np.arange(SUBSTEPS)).ravel()
    values = np.asarray(torques.values[0])[:, :SUBSTEPS].ravel()
    return stamps[stamps <= last], values[stamps <= last]


def _ticks(records: BagRecords) -> dict[Topic, TopicColumns]:
    """Return the messages on the topics of a bag, of an unfinished one those of whole ticks."""
    sticks = CLUTCH_PHASE.resolved_name in records.topics
    run = RunKind(clutch=STICK_SLIP if sticks else LINEAR)
    topics = [topic for topic in _TOPICS if topic.in_run(run)]
    found = read_columns(records, {topic: topic.signals_in(run) for topic in topics})
    if records.unfinished:
        end = min(each.stamps.max(initial=0) for each in found.values())
        found = {topic: each.until(end) for topic, each in found.items()}
    for topic, each in found.items():
        name = topic.resolved_name
        if not each.stamps.size:
            raise DdctError(f'no {name}: not a recording of this project', key=name)
        stamps, counts = np.unique(each.stamps, return_counts=True)
        if counts.max() > 1:
            raise DdctError(f'{name} has two messages at {stamps[counts > 1][0]} ns', key=name)
    _require_steps(np.sort(found[JOINT_STATES].stamps))
    return found


def _require_steps(stamps: np.ndarray) -> None:
    """Raise DdctError unless rising stamps in ns are those of each step of the run."""
    missing = np.flatnonzero(stamps != START_NS + PERIOD_NS * np.arange(len(stamps)))
    if missing.size:
        name = JOINT_STATES.resolved_name
        raise DdctError(f'{name} has no message at step {missing[0]}', key=name)
