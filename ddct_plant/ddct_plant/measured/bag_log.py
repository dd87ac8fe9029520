"""What a bag of ours holds of a drive, as a car's own sensors would have measured it."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import START_NS, SUBSTEPS
from ddct_plant.files.input_file import mcap_of
from ddct_plant.graph.topics import (
    CLUTCH_PHASE,
    CLUTCH_TORQUE,
    ENGINE_TORQUE,
    JOINT_STATES,
    VEHICLE_ACCEL,
    Topic,
)

_NS_PER_S = 1e9
_SPEEDS = ('engine_speed', 'shaft_speed', 'wheel_speed')


def bag_file(path: Path) -> Path | None:
    """Return the MCAP file that a path is or holds, None for any other file."""
    return mcap_of(path) if path.suffix == '.mcap' or path.is_dir() else None


def read_bag_signals(
    path: Path,
) -> tuple[np.ndarray, dict[str, np.ndarray], tuple[str, ...]]:
    """
    Return times (n,) in s, signals by quantity and the names of those that are held.

    Speeds, C_m and A_x come every 10 ms. C_f comes every 1 ms of the clutch that always slips; of
    one that sticks it is what was transmitted just before each tick. C_load is left out: no car
    measures it. Of a run with sensors these are the true signals too.
    """
    try:
        values = {
            topic: dict(_values(path, topic))
            for topic in (JOINT_STATES, ENGINE_TORQUE, CLUTCH_TORQUE, CLUTCH_PHASE, VEHICLE_ACCEL)
        }
    except (McapError, OSError, ValueError, LookupError, AttributeError) as error:
        raise DdctError(f'{path}: cannot be read as a bag ({error}): repair it first') from error
    if not values[JOINT_STATES] or not values[ENGINE_TORQUE]:
        raise DdctError(
            f'{path}: no {JOINT_STATES.resolved_name}: not a recording of this project'
        )
    rows: dict[int, dict[str, float]] = {}
    for stamp, (_, speeds, efforts) in values[JOINT_STATES].items():
        row = rows.setdefault(stamp, {})
        row.update(zip(_SPEEDS, speeds, strict=False))
        if values[CLUTCH_PHASE]:
            row['clutch_torque'] = efforts[1]
    for stamp, (torque,) in values[ENGINE_TORQUE].items():
        rows.setdefault(stamp, {})['engine_torque'] = torque
    for stamp, (accel,) in values[VEHICLE_ACCEL].items():
        rows.setdefault(stamp, {})['vehicle_accel'] = accel
    last = max(values[JOINT_STATES])
    for stamp, (nodes, *_) in values[CLUTCH_TORQUE].items() if not values[CLUTCH_PHASE] else ():
        for index in range(SUBSTEPS) if stamp < last else (0,):
            rows.setdefault(stamp + index * 1_000_000, {})['clutch_torque'] = nodes[index]
    stamps = sorted(rows)
    names = (*_SPEEDS, 'engine_torque', 'clutch_torque', 'vehicle_accel')
    signals = {name: np.array([rows[s].get(name, np.nan) for s in stamps]) for name in names}
    return (np.array(stamps) - START_NS) / _NS_PER_S, signals, ('engine_torque',)


def _values(path: Path, topic: Topic) -> Iterator[tuple[int, tuple[Any, ...]]]:
    with path.open('rb') as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, _, message, decoded in reader.iter_decoded_messages([topic.resolved_name]):
            yield message.log_time, topic.values(decoded)
