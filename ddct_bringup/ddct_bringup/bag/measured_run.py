# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Convert a log of another tool to a recording, so that it is scored and shown as a bag is."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.bag.measured_checks import require_no_contradiction
from ddct_bringup.bag.measured_keys import MeasuredKeys
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import MEASURED, RunFacts
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.logs.columns import QUANTITIES, TIME, ColumnMap
from ddct_bringup.logs.log import MeasuredLog, read_log
from ddct_bringup.logs.sources import LOGS
from ddct_plant.base.errors import DdctError
from ddct_plant.base.options import options_of, require_known
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.files.input_file import located
from ddct_plant.signals.topic import RunKind, Signal
from ddct_plant.signals.topics import recorded_topics

NEEDED = ('engine_speed', 'shaft_speed')
TORSION = 'torsion_speed'
"""Name of the signal that is computed from shaft_speed, wheel_speed and the total ratio."""
_LONGEST_GAP_S = 0.1
_SLOWEST_S = 0.02
"""Largest sample period, s, of signals that contain modes of the driveline."""
_AVERAGED_BELOW_S = 0.5 * PERIOD_S
_MORE_SIGNALS = {
    TORSION: ('driveshaft_speed',),
    'engine_torque': ('engine_effort',),
    'load_torque': ('wheel_effort',),
}
"""Signals that have a quantity too, besides the one in `QUANTITIES`."""


def is_log(path: Path) -> bool:
    """Return whether a path is a log of another tool rather than a bag."""
    return path.suffix.lower() in LOGS


def read_recording(path: Path, columns: ColumnMap | None) -> Recording:
    """Return the recording of a bag, or of a log by its column map; raise DdctError."""
    if not is_log(path):
        return read_bag(path)
    if columns is None:
        raise DdctError(f'{path}: the log needs a column map: give --columns FILE')
    return read_measured_run(path, columns)


def read_measured_run(path: Path, columns: ColumnMap) -> Recording:
    """
    Return a log as a recording on the grid of 10 ms.

    Samples closer than 5 ms are averaged over the 10 ms around each instant; others are
    interpolated or held, as the column map sets. Quantities that the log lacks are NaN, with the
    reason in `absent`. Raise DdctError for a log that cannot be read, is too short, has a gap over
    0.1 s, or contradicts the values under `run` or the units and signs of the column map.
    """
    log = read_log(path, columns, NEEDED)
    require_known(columns.run, options_of(MeasuredKeys), prefix='run.')
    run = MeasuredKeys(**columns.run)
    start_s = log.time_s[0] if run.start_s is None else run.start_s
    steps = int(np.floor((log.time_s[-1] - start_s) / PERIOD_S + 1e-6))
    if start_s < log.time_s[0] - 1e-6 or steps < 1:
        raise DdctError(
            f'{path}: it has {log.time_s[0]:g} to {log.time_s[-1]:g} s, which run.start_s, '
            f'{start_s:g} s, does not begin: give a time within'
        )
    grid_s = start_s + PERIOD_S * np.arange(steps + 1)
    values = {name: _on_grid(log, name, grid_s) for name in log.signals}
    with located(str(path)):
        run.require_within(time_of_step(steps))
        require_no_contradiction(run.gear, values)
    absent = {}
    if run.gear and 'wheel_speed' in values:
        values[TORSION] = run.gear.wheel_speed(values['shaft_speed']) - values['wheel_speed']
    else:
        absent[TORSION] = 'w_sr needs the column wheel_speed and run.total_ratio'
    for name in QUANTITIES:
        if name not in (*values, TIME, 'wheel_speed'):
            absent[name] = f'the log has no {name}'
    for name, of in (('vehicle_accel', 'vehicle_accel'), (TORSION, 'wheel_speed')):
        if name in values and (apart := _apart(log, of)) > _SLOWEST_S:
            del values[name]
            absent[name] = f'the samples of {of} are {apart:g} s apart, more than {_SLOWEST_S:g} s'
    return Recording(
        path=path,
        trajectory=_trajectory(values, steps),
        facts=_facts(run, steps),
        absent=absent,
    )


def _facts(run: MeasuredKeys, steps: int) -> RunFacts:
    duration_s = time_of_step(steps)
    first_s, last_s = run.score_window_s or (run.control_start_s, duration_s)
    return RunFacts(
        controller=run.controller,
        architecture=MEASURED,
        scenario=run.scenario,
        wear_gain=run.wear_gain,
        mode=MEASURED,
        seed=0,
        control_start_s=run.control_start_s,
        score_window_s=(first_s, last_s),
        duration_s=duration_s,
        clutch=MEASURED,
    )


def _on_grid(log: MeasuredLog, name: str, grid_s: np.ndarray) -> np.ndarray:
    times, values = log.samples(name)
    if not times.size:
        raise DdctError(f'{log.path}: {name} has no value in any row: leave it out of the columns')
    near = (times >= grid_s[0] - _LONGEST_GAP_S) & (times <= grid_s[-1] + _LONGEST_GAP_S)
    edges = np.concatenate([[grid_s[0]], times[near], [grid_s[-1]]])
    longest = int(np.argmax(np.diff(edges)))
    if edges[longest + 1] - edges[longest] > _LONGEST_GAP_S:
        raise DdctError(
            f'{log.path}: {name} has no sample from {edges[longest]:g} to {edges[longest + 1]:g} '
            f's, more than {_LONGEST_GAP_S:g} s: score the parts, or mend the log'
        )
    if _apart(log, name) >= _AVERAGED_BELOW_S:
        return log.at(name, grid_s)
    sums = np.concatenate([[0.0], np.cumsum(values)])
    first = np.searchsorted(times, grid_s - 0.5 * PERIOD_S)
    last = np.searchsorted(times, grid_s + 0.5 * PERIOD_S)
    few = last == first
    means = (sums[last] - sums[first]) / np.where(few, 1, last - first)
    return np.where(few, log.at(name, grid_s), means)


def _apart(log: MeasuredLog, name: str) -> float:
    """Return the median time in s between samples, in whole ns: decimal times are rounded."""
    times = log.samples(name)[0]
    return round(float(np.median(np.diff(times))), 9) if len(times) > 1 else np.inf


def _trajectory(values: Mapping[str, np.ndarray], steps: int) -> Trajectory:
    """Return every signal that a run with the linear clutch has; NaN for those not in the log."""
    run = RunKind()
    trajectory = Trajectory.of_columns(
        {
            signal.name: _nothing(signal, steps + 1)
            for topic in recorded_topics(run)
            for signal in topic.signals_in(run)
        }
    )
    for name, samples in values.items():
        own = (QUANTITIES[name].signal,) if name in QUANTITIES else ()
        for quantity in (*own, *_MORE_SIGNALS.get(name, ())):
            trajectory.at_tick(quantity)[:] = samples
    trajectory.slip_speed[:] = values['engine_speed'] - values['shaft_speed']
    return trajectory


def _nothing(signal: Signal, count: int) -> Any:
    """Return `count` rows of NaN, or empty texts."""
    if not signal.unit:
        return ((),) * count
    return np.full(count if signal.size == 1 else (count, signal.size or 1), np.nan)
