# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Update times of judged controllers as ratios to that of `pi`, in turn with it on this machine.

They are wall-clock times, so they differ each time, and stand in a file of their own.
"""

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import TIMING_FILE, RunTiming
from ddct_controllers.registry import Chosen
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.files.json_records import read_json, write_json
from ddct_plant.scenario.settings import RunSettings

REFERENCE = 'pi'
_ROUNDS = 3
"""Number of runs of each, in turn, so that a busy machine slows both alike."""


@dataclass(frozen=True)
class UpdateTime:
    """Update time of a controller."""

    update_time_over_pi: float
    lowest_ratio: float
    highest_ratio: float
    update_time_median_us: float
    pi_update_time_median_us: float


@dataclass(frozen=True)
class NoUpdateTime:
    """Reason for the missing update time of a controller."""

    update_time_over_pi: None
    reason: str


@dataclass(frozen=True)
class UpdateTimesFile:
    """Content of the file: the controller of the denominator, and the update times by name."""

    reference: str
    controllers: Mapping[str, UpdateTime | NoUpdateTime]


def write_update_times(judged: Sequence[Judged], cases: Cases, out: Path) -> None:
    """Measure the update times and write them into a folder, unless they are there."""
    if (out / TIMING_FILE).exists():
        return
    settings = cases.planned.run(0).settings
    found = {each.name: _update_time(each, settings) for each in judged}
    write_json(str(out / TIMING_FILE), UpdateTimesFile(REFERENCE, found))


def read_update_times(out: Path) -> UpdateTimesFile:
    """Return the content of the file in a folder; raise DdctError for one that is damaged."""
    advice = 'delete the file, and the same command measures the update times again'
    return read_json(UpdateTimesFile, out / TIMING_FILE, advice=advice)


def median_ratio(chosen: Chosen, reference: str, settings: RunSettings) -> float:
    """Return the ratio of two controllers' update times, the median over runs in turn."""
    ratios = []
    for _ in range(_ROUNDS):
        other = _median_us(reference, settings)
        ratios.append(_median_us(chosen, settings) / other)
    return statistics.median(ratios)


def _update_time(judged: Judged, settings: RunSettings) -> UpdateTime | NoUpdateTime:
    """Return the median update times in us, and the median of their ratios over the rounds."""
    ours, theirs = [], []
    try:
        for _ in range(_ROUNDS):
            theirs.append(_median_us(REFERENCE, settings))
            ours.append(_median_us(judged.path, settings))
    except FOREIGN_FAILURES as error:
        return NoUpdateTime(update_time_over_pi=None, reason=f'{type(error).__name__}: {error}')
    ratios = [mine / other for mine, other in zip(ours, theirs, strict=True)]
    return UpdateTime(
        update_time_over_pi=statistics.median(ratios),
        lowest_ratio=min(ratios),
        highest_ratio=max(ratios),
        update_time_median_us=statistics.median(ours),
        pi_update_time_median_us=statistics.median(theirs),
    )


def _median_us(chosen: Chosen, settings: RunSettings) -> float:
    timing = RunTiming()
    run_headless(settings, chosen, timing)
    return statistics.median(timing.update_times_us)
