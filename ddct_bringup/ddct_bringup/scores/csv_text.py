# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scores and signals as CSV."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.scores.document import FACTS
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_plant.base.errors import printable
from ddct_plant.files.csv_table import csv_text
from ddct_plant.signals.topic import Signal, column_name
from ddct_plant.signals.topics import (
    JOINT_STATES,
    SENSED_JOINT_STATES,
    SLIP,
    SLIP_REFERENCE,
    all_signals,
)

Cell = str | float | int | list[str] | None
"""Value in one column of a row."""
_OF_JOINTS = (JOINT_STATES, SENSED_JOINT_STATES)
"""Topics with one value per joint: the first columns, joint by joint."""


def scores_csv(runs: Sequence[ScoredRun]) -> str:
    """Return the scores as CSV, one row per run: facts, metrics and state."""
    rows = [score_row(run) for run in runs]
    return csv_text(rows[0], ([_text(value) for value in row.values()] for row in rows))


def score_row(run: ScoredRun) -> dict[str, Cell]:
    """Return the facts, metrics and state of a run by column."""
    return {
        'bag': run.bag,
        **{name: getattr(run.facts, name, None) for name in FACTS},
        'valid': run.valid,
        'reason': run.reason,
        'fallbacks': run.fallbacks,
        'safe_state': run.safe_state,
        'scenario_changes': None if run.scenario_changes is None else list(run.scenario_changes),
        'gain_changes': [each.text for each in run.gain_changes],
        **run.metrics,
        'least_is_bound': run.least_is_bound,
        'state': run.state,
        'why': run.why,
    }


def signals_csv(recording: Recording) -> str:
    """Return the signals as CSV, one row per tick, with the columns of `signal_columns`."""
    columns = signal_columns(recording.trajectory)
    # Python prints a float with enough digits to recover every bit.
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return csv_text(columns, rows)


def signal_columns(trajectory: Trajectory) -> dict[str, np.ndarray]:
    """
    Return every numeric signal, (N+1,), by its name with the unit; time first.

    For previews and for torques within a period it is the value at the tick.
    """
    columns = {'time_s': trajectory.time_s, **_joint_columns(trajectory)}
    for signal in sorted(all_signals(), key=_place):
        if signal.unit and signal.name in trajectory.signals and not signal.parts:
            columns[signal.column] = trajectory.at_tick(signal.name)
    return columns


def _text(value: Cell) -> Cell:
    return printable(value) if isinstance(value, str) else value


def _joint_columns(trajectory: Trajectory) -> dict[str, np.ndarray]:
    return {
        column_name(name, signal.unit): trajectory.at_tick(name)
        for topic in _OF_JOINTS
        for names in zip(*(signal.parts for signal in topic.signals), strict=True)
        for name, signal in zip(names, topic.signals, strict=True)
        if signal.name in trajectory.signals
    }


def _place(signal: Signal) -> int:
    """Return the sort index of a column: the slip and its reference come first."""
    first = (*SLIP.signals, *SLIP_REFERENCE.signals)
    return first.index(signal) if signal in first else len(first)
