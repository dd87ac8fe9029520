# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files beside a bag: `timing.json`, and `failed_run.json` of a run that failed."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.bag.realtime_facts import RealtimeCounts
from ddct_bringup.bag.run_facts import RunFacts, described_run
from ddct_plant.base.errors import (
    DdctError,
    ParameterError,
    printable,
    require_number,
    without_folders,
)
from ddct_plant.files.json_records import json_line, read_json, write_json
from ddct_plant.files.output_file import write_text

TIMING_FILE = 'timing.json'
NOTE_FILE = 'failed_run.json'
_ADVICE = 'choose another output folder'


@dataclass
class RunTiming(RealtimeCounts):
    """Content of `timing.json`: wall-clock times and counts, kept out of the deterministic bag."""

    update_times_us: list[float] = field(default_factory=list)
    """Wall time of each controller update in us, in order."""
    refused_messages: int = 0
    """Number of messages refused for an impossible stamp; real time only."""
    wall_time_s: float = 0.0
    """Wall time from the first tick to the last, s."""
    steps: int = 0

    def __post_init__(self) -> None:
        """Raise ParameterError for a time or a count below 0."""
        for name in ('missed_steps', 'resends', 'late_messages', 'refused_messages', 'steps'):
            require_number(name, getattr(self, name), at_least=0.0)
        samples = (*self.update_times_us, *self.lateness_us, *self.latency_us)
        times = (self.wall_time_s, *self.safe_states.values(), *samples)
        if min(times) < 0.0:
            raise ParameterError(f'a time is {min(times):g}: it must be at least 0')

    def write(self, folder: Path) -> None:
        """Write `timing.json` into a bag's folder; raise DdctError when that fails."""
        write_text(str(folder / TIMING_FILE), json_line(self) + '\n', _ADVICE)


def read_timing(folder: Path) -> RunTiming | None:
    """Return the timing of a bag folder, None without one; raise DdctError for invalid content."""
    path = folder / TIMING_FILE
    if not path.exists():
        return None
    return read_json(RunTiming, path, advice='delete it to score without')


@dataclass(frozen=True)
class RunFailure:
    """Reason of a failed run, and its planned facts."""

    reason: str
    facts: RunFacts | None = None
    """Planned facts of the run; None where the note cannot be read."""
    custom_data: dict[str, str] = field(default_factory=dict)
    """Custom data that the bag of the run has, or would have; empty without facts."""


@dataclass(frozen=True)
class _FailureNote:
    """Content of `failed_run.json`."""

    reason: str
    run: Mapping[str, str]
    """Custom data that the bag of the run has, or would have."""


def note_failure(folder: Path, reason: str, custom_data: Mapping[str, str]) -> None:
    """
    Write the reason of a failure into a run's folder; `custom_data` is that of its bag.

    Raise DdctError when that fails.
    """
    write_json(
        str(folder / NOTE_FILE), _FailureNote(without_folders(reason), custom_data), _ADVICE
    )


def failed_run(folder: Path) -> RunFailure | None:
    """
    Return the failure noted in a run's folder; None without a note.

    A note that cannot be read still marks the run as failed.
    """
    path = folder / NOTE_FILE
    if not path.exists():
        return None
    try:
        note = read_json(_FailureNote, path)
        facts = described_run(note.run)[1]
    except DdctError as error:
        return RunFailure(printable(f'the run failed, and why cannot be read: {error}'))
    return RunFailure(printable(note.reason), facts, dict(note.run))
