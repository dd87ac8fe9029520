# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Validity of a run, and the one-line summary of a real-time run."""

import math

import numpy as np

from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.errors import MOST_SIGNAL
from ddct_plant.base.timebase import START_NS, time_of_step
from ddct_plant.signals.topics import (
    CLUTCH_TORQUE,
    ENGINE_TORQUE,
    HOLDING_TORQUE,
    LOAD_TORQUE,
    OFF_GOING_CLUTCH_TORQUE,
)

MISS_TOLERANCE = 0.01
"""
Largest share of steps without a reply in a valid real-time run.

A machine under load missed 6 of 2500, which does not change the metrics; a node that stops for
half a second misses 50 of 300.
"""


_TORQUES = (ENGINE_TORQUE, LOAD_TORQUE, CLUTCH_TORQUE, HOLDING_TORQUE, OFF_GOING_CLUTCH_TORQUE)
"""Topics to which the driveline holds the last value for lack of a reply."""


def why_invalid(recording: Recording) -> str:
    """Return why a run is invalid; empty if it is valid, also where its engine ended it early."""
    trajectory, facts = recording.trajectory, recording.facts
    reasons = [] if facts.lockstep else why_not_real_time(recording)
    if trajectory.steps < facts.steps and not engine_end(recording):
        reasons.insert(0, _why_early(recording))
    wrong = [] if recording.measured else wrong_values(trajectory)
    return '; '.join([*reasons, *wrong])


def incomplete(recording: Recording) -> str:
    """Return how much of a run an unfinished bag has, which is why it is invalid; else ''."""
    if not recording.unfinished:
        return ''
    return f'incomplete: {recording.trajectory.steps} of {recording.facts.steps} steps'


def wrong_values(trajectory: Trajectory) -> list[str]:
    """Return for each signal with a value that no signal has the time of the first such value."""
    found = []
    for name, values in trajectory.signals.items():
        if not isinstance(values, np.ndarray) or (good := are_signals(values)).all():
            continue
        rows = good.reshape(len(values), -1).all(axis=1)
        row = int(np.flatnonzero(~rows)[0])
        what = 'non-finite value'
        if np.isfinite(values[row]).all():
            what = f'value beyond +-{MOST_SIGNAL:g}'
        found.append(f'{what} in {name} at {time_of_step(row):g} s')
    return found


def are_signals(values: np.ndarray) -> np.ndarray:
    """Return for each value whether a signal can have it, as `require_signal` checks it."""
    good: np.ndarray = np.abs(values) <= MOST_SIGNAL
    return good


def engine_end(recording: Recording) -> str | None:
    """Return `stalled` or `over_revved` where the last state of the engine ended the run."""
    if recording.settings is None:
        return None
    speed = float(recording.trajectory.engine_speed[-1])
    return recording.settings.scenario.end_cause(speed)


def _why_early(recording: Recording) -> str:
    got, planned = recording.trajectory.steps, recording.facts.steps
    early = f'ended early: {got} of {planned} steps'
    if recording.facts.lockstep:
        return early
    if recording.realtime.steps >= planned:
        return f'{early}: the driveline took them all, but the recorder did not receive the last'
    return f'{early}: the driveline last counted at step {recording.realtime.steps}'


def missed_steps(recording: Recording) -> int:
    """
    Return the number of steps at which the last torque was held for lack of a reply.

    The driveline counts them. Replies that are missing from the bag alone count too, since its
    signals hold the last value there.
    """
    held = (recording.missed.get(topic.name, 0) for topic in _TORQUES)
    return max(recording.realtime.missed_steps, *held)


def safe_state(recording: Recording) -> str:
    """Return the node that entered its safe state and the scenario time, or ''."""
    states = sorted(recording.realtime.safe_states.items(), key=lambda each: each[1])
    return ', '.join(f'{node} at {(stamp - START_NS) / 1e9:g} s' for node, stamp in states)


def why_not_real_time(recording: Recording) -> list[str]:
    """Return why a complete real-time run is invalid; empty if it is valid."""
    reasons = []
    missed, steps = missed_steps(recording), recording.trajectory.steps
    if missed > MISS_TOLERANCE * steps:
        reasons.append(
            f'{missed} of {steps} steps held a torque for want of a reply, more than '
            f'{math.floor(MISS_TOLERANCE * steps)} (1 %)'
        )
    if states := safe_state(recording):
        reasons.append(f'safe state entered by {states}')
    return reasons


def realtime_summary(recording: Recording) -> str:
    """Return missed steps, worst lateness and safe state in one line."""
    lateness = recording.realtime.worst_lateness_us
    late = 'unknown' if lateness is None else f'{lateness / 1e3:.2f} ms'
    return (
        f'{missed_steps(recording)} of {recording.trajectory.steps} steps missed, worst lateness '
        f'{late}, safe state: {safe_state(recording) or "none"}'
    )
