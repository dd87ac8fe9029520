# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals of a recorded bag as a car's own sensors would measure them."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ddct_plant.bag_file.decoding import decoded_messages
from ddct_plant.bag_file.facts import require_last_step
from ddct_plant.bag_file.records import BagRecords, read_records
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import START_NS, SUBSTEP_NS, SUBSTEPS, stamp_of_step, step_of_stamp
from ddct_plant.files.input_file import located
from ddct_plant.measured.columns import QUANTITIES
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
_Rows = Mapping[int, Any]
"""Values of a signal by stamp in ns."""


def read_bag_signals(bag: Path) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """
    Return the times in s of the MCAP file of a bag, (n,), and by quantity its values, (n,).

    Speeds, C_m, V_x and A_x are sampled every 10 ms. C_f is sampled every 1 ms with the linear
    clutch; with the stick-slip clutch it is the transmitted torque just before each tick. C_load
    is omitted, because no car measures it. In a run with sensors the signals are the true ones,
    too.
    Raise DdctError for a file that is no recording of this project or is damaged, and for a value
    that is missing, given twice or not finite.
    """
    records = read_records(bag)
    with located(str(bag)):
        rows = _signal_rows(records)
        by_stamp = {name: _at_ticks(rows, QUANTITIES[name].signal) for name in _MEASURED}
        if not rows['clutch_phase']:
            by_stamp['clutch_torque'] = _within_periods(
                rows['clutch_torque'], max(rows['joint_speed'])
            )
        for name, found in by_stamp.items():
            if not all(map(math.isfinite, found.values())):
                raise DdctError(f'{name} has a value that is not finite: record the run again')
    stamps = sorted(set().union(*by_stamp.values()))
    signals = {
        name: np.array([found.get(stamp, np.nan) for stamp in stamps])
        for name, found in by_stamp.items()
    }
    return (np.array(stamps) - START_NS) / 1e9, signals


def _at_ticks(rows: Mapping[str, _Rows], name: str) -> dict[int, float]:
    """Return a quantity by stamp in ns."""
    signal, index = quantities()[name]
    found = rows[signal.name]
    return {stamp: row if index is None else row[index] for stamp, row in found.items()}


def _within_periods(rows: _Rows, last: int) -> dict[int, float]:
    """Return a torque every 1 ms by stamp in ns, up to the stamp `last`."""
    return {
        stamp + index * SUBSTEP_NS: torques[index]
        for stamp, torques in rows.items()
        for index in range(SUBSTEPS if stamp < last else 1)
    }


def _signal_rows(records: BagRecords) -> dict[str, dict[int, Any]]:
    """Return the values of the messages, by signal and by stamp in ns."""
    rows: dict[str, dict[int, Any]] = {
        signal.name: {} for topic in _TOPICS for signal in topic.signals
    }
    for topic, stamp, message in decoded_messages(records, _TOPICS):
        first = topic.signals[0].name
        if stamp in rows[first]:
            raise DdctError(f'{topic.resolved_name} has two messages at {stamp} ns')
        try:
            # The linear clutch has the first of its two signals only.
            for signal, values in zip(topic.signals, topic.values(message), strict=False):
                rows[signal.name][stamp] = values
        except (LookupError, AttributeError, ValueError, TypeError) as error:
            raise DdctError(
                f'{topic.resolved_name}: a message lacks a value ({error})',
                key=topic.resolved_name,
            ) from error
    for topic in _TOPICS:
        found = rows[topic.signals[0].name]
        if topic is not CLUTCH_PHASE and not found:
            raise DdctError(
                f'no {topic.resolved_name}: not a recording of this project',
                key=topic.resolved_name,
            )
    last = step_of_stamp(max(rows['joint_speed']))
    require_last_step(records.custom_data, last)
    for step in range(last + 1):  # ends at the first that is missing, however late the last is
        if stamp_of_step(step) not in rows['joint_speed']:
            raise DdctError(
                f'{JOINT_STATES.resolved_name} has no message at step {step}',
                key=JOINT_STATES.resolved_name,
            )
    return rows
