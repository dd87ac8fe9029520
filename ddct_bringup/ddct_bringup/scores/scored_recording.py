# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The path of one run: execute its plan, read its bag unless it is in memory, score it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ddct_bringup.bag.measured_run import read_recording
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.logs.columns import ColumnMap
from ddct_bringup.run.execution import execute, simulate
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.timing_and_failure import RunTiming, failed_run, read_timing
from ddct_bringup.scores.bags import bag_name
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import run_without_score, score_run, unreadable_run
from ddct_bringup.scores.validity import incomplete
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import scenario_digest
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class ScoredRecording:
    """A scored run with its evidence: the recording and the timing."""

    scores: ScoredRun
    recording: Recording | None = None
    """Recording; None where the bag cannot be read."""
    timing: RunTiming | None = None
    """Times on the wall clock, and counts; None without a `timing.json`."""

    @property
    def path(self) -> Path:
        """Path of the MCAP file; raise DdctError where the bag cannot be read."""
        if self.recording is None:
            raise DdctError(f'{self.scores.bag}: cannot be read: {self.scores.reason}')
        return self.recording.path

    @property
    def measured(self) -> bool:
        """Whether it is the log of a car."""
        return self.recording is not None and self.recording.measured

    @property
    def settings(self) -> RunSettings | None:
        """Settings of the run; None of a log, and of a bag that cannot be read."""
        return self.recording.settings if self.recording else None

    @cached_property
    def digest(self) -> str | None:
        """Digest that distinguishes scenarios of one name, None without settings."""
        return scenario_digest(self.settings.scenario) if self.settings else None


def run_and_score(
    plan: RunPlan,
    folder: Path,
    limits: Limits,
    carry_out: Callable[[RunPlan, Path], Recording | None] = execute,
) -> ScoredRecording:
    """
    Execute a plan into the existing `folder` and score it.

    What `carry_out`, which executes, returns is scored from memory; where it returns None, the bag
    is read. Raise the errors of `carry_out`, and DdctError for a bag that cannot be read.
    """
    recording = carry_out(plan, folder)
    return score_recording(recording or read_bag(folder), plan.name, limits)


def simulate_and_score(plan: RunPlan, limits: Limits) -> ScoredRecording:
    """Execute a headless plan in memory and score it; no file is written."""
    recording, timing = simulate(plan)
    return ScoredRecording(score_run(recording, plan.name, limits, timing), recording, timing)


def score_bag(
    bag: Path, name: str, limits: Limits, columns: ColumnMap | None = None
) -> ScoredRecording:
    """Read and score a bag, or a log with its column map; raise DdctError if it is unreadable."""
    return score_recording(read_recording(bag, columns), name, limits)


def score_any_bag(
    bag: Path, folder: Path | None, limits: Limits, columns: ColumnMap | None = None
) -> ScoredRecording:
    """Score a bag, named relative to `folder`; one that is unreadable has its reason."""
    try:
        return score_bag(bag, bag_name(bag, folder), limits, columns)
    except DdctError as error:
        return ScoredRecording(unreadable_run(bag, error, relative_to=folder))


def score_recording(recording: Recording, name: str, limits: Limits) -> ScoredRecording:
    """
    Score and judge a recording, with its `timing.json` if there is one; `name` is its bag's.

    The recording of a failed run has no score. Raise DdctError for timing that cannot be used.
    """
    if recording.measured:
        return ScoredRecording(score_run(recording, name, limits, None), recording)
    folder = recording.path.parent
    timing = read_timing(folder)
    if failure := failed_run(folder):
        reasons = filter(None, (incomplete(recording), failure.reason))
        scores = run_without_score(name, recording.facts, '; '.join(reasons))
    else:
        scores = score_run(recording, name, limits, timing)
    return ScoredRecording(scores, recording, timing)
