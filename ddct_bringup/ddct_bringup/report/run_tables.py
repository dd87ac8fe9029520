# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of each run besides its scores: its origin, and its update times."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_bringup.run.description import UNKNOWN
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_plant.base.timebase import PERIOD_S

_CONDITIONS = ('controller', 'architecture', 'wear_gain', 'mode', 'seed')
_REPEATED = ('version',)
"""Facts that every node publishes and that the page shows elsewhere."""
_FIRST_US, _LAST_US = 1.0, 1e5


@dataclass(frozen=True)
class RunOrigin:
    """Conditions of a run, and the facts that each node published about itself."""

    conditions: tuple[tuple[str, str], ...]
    nodes: tuple[tuple[str, tuple[tuple[str, str], ...]], ...]
    commit: str
    version: str


def run_origin(run: ScoredRecording) -> RunOrigin:
    """Return the origin of a run, with dashes for missing facts of a log or an unreadable bag."""
    unknown = ('seed',) if run.measured else ()
    facts = run.scores.facts
    conditions = tuple(
        (name, '–' if facts is None or name in unknown else str(getattr(facts, name)))
        for name in _CONDITIONS
    )
    if run.recording is None or run.measured:
        return RunOrigin(conditions, (), '–', '–')
    nodes = {
        node: tuple((key, value) for key, value in pairs.items() if key not in _REPEATED)
        for node, pairs in sorted(run.recording.run_info.items())
    }
    custom = run.recording.custom_data
    return RunOrigin(
        conditions,
        tuple((node, pairs) for node, pairs in nodes.items() if pairs),
        custom.get('commit', UNKNOWN),
        custom.get('version', UNKNOWN),
    )


@dataclass(frozen=True)
class UpdateTimes:
    """Statistics of `timing.json` of one run."""

    median_us: float
    p99_us: float
    largest_us: float
    timing: RunTiming
    """Complete content of the file."""
    over_period: int
    """Number of updates that took longer than the period."""


def update_times(run: ScoredRecording) -> UpdateTimes | None:
    """Return the update times of a run, None where none were recorded."""
    timing = run.timing
    median, p99 = (run.scores.metrics[f'update_time_{name}_us'] for name in ('median', 'p99'))
    if timing is None or median is None or p99 is None:
        return None
    over_period = int(np.sum(np.array(timing.update_times_us) > 1e6 * PERIOD_S))
    return UpdateTimes(median, p99, max(timing.update_times_us), timing, over_period)


def time_place(time_us: float) -> float:
    """Return the position of a wall time along the logarithmic scale of the table, 0 to 1."""
    place = math.log10(max(time_us, _FIRST_US) / _FIRST_US) / math.log10(_LAST_US / _FIRST_US)
    return min(place, 1.0)


TICKS = {'1 µs': 1.0, '10 µs': 1e1, '100 µs': 1e2, '1 ms': 1e3, '10 ms': 1e4}
"""Ticks of the scale, text and time in us; the last is the period."""
