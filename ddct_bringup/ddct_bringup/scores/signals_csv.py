"""The signals of a recording as a CSV file, one row per tick, units in the names."""

import csv
import io

import numpy as np

from ddct_bringup.bag.reader import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.graph.topics import (
    JOINT_STATES,
    JOINTS,
    SLIP,
    SLIP_REFERENCE,
    Signal,
    all_signals,
)


def signals_csv(recording: Recording) -> str:
    """Return the text; of previews and torques within the period the value at the tick."""
    trajectory = recording.trajectory
    columns = {'time_s': trajectory.time_s, **_joint_columns(trajectory)}
    for signal in sorted(all_signals(), key=_place):
        if (
            signal.unit
            and signal.name in trajectory.signals
            and signal not in JOINT_STATES.signals
        ):
            values = trajectory.signals[signal.name]
            columns[signal.column] = np.array(values).reshape(len(values), -1)[:, 0]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow(columns)
    # Python's floats print with the digits that give them back to the last bit.
    writer.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))
    return text.getvalue()


def _joint_columns(trajectory: Trajectory) -> dict[str, np.ndarray]:
    return {
        signal.column.replace('joint', joint): trajectory.signals[signal.name][:, index]
        for index, joint in enumerate(JOINTS)
        for signal in JOINT_STATES.signals
    }


def _place(signal: Signal) -> int:
    """Return where a column stands: the slip and its reference first, beside each other."""
    first = (*SLIP.signals, *SLIP_REFERENCE.signals)
    return first.index(signal) if signal in first else len(first)
