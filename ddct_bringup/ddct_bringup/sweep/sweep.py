# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sweep: every controller at every point of its axes, headless, scored, judged."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

import pyarrow as pa

from ddct_bringup.bag.run_facts import RunConditions, ShiftConditions
from ddct_bringup.campaign.columns import runs_table, schema_over
from ddct_bringup.campaign.rows import ScoredRow
from ddct_bringup.campaign.run_set import RunSet
from ddct_bringup.campaign.scored import scored_runs
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.scores.document import (
    NoConditions,
    ScoresEntry,
    ShiftEntry,
    UnreadableEntry,
    run_entry,
)
from ddct_bringup.scores.shift_conditions import shift_conditions
from ddct_bringup.sweep.axis import MOST, Axis
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.registry import Chosen, controller_label, controller_spec
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.json_records import Inline
from ddct_plant.scenario.differences import scenario_title
from ddct_plant.scenario.settings import RunSettings

SCHEMA_VERSION = 1
"""Schema version of the output of `ddct sweep --json`."""


@dataclass(frozen=True)
class Sweep:
    """Runs of a sweep: controllers and settings, checked when built."""

    base: RunBase
    axes: Sequence[Axis]
    controllers: Sequence[Chosen]
    limits: Limits

    def __post_init__(self) -> None:
        """Build the settings of points, and every controller at the first; raise DdctError."""
        keys = [axis.key for axis in self.axes]
        for key in keys:
            if keys.count(key) > 1:
                raise ParameterError(f'--over names {key} twice: name each key once')
        points = prod(len(axis.values) for axis in self.axes)
        if points > MOST:
            raise ParameterError(
                f'--over gives {points} points: at most {MOST}, `ddct campaign` is made for more'
            )
        if not self.first.known.lockstep:
            raise ParameterError(
                f'mode is {self.first.known.mode}, but a sweep needs no graph: leave the mode out'
            )
        self.run_set.require_sound()

    @cached_property
    def run_set(self) -> RunSet:
        """Runs of every controller at every point; the last axis changes fastest."""
        return RunSet(
            controllers=[controller_spec(each) for each in self.controllers],
            bases={self.base.file.choice: self.base},
            common=self.base.file.choice.given,
            grid={axis.key: axis.values for axis in self.axes},
        )

    @cached_property
    def first(self) -> RunSettings:
        """Settings of the first point."""
        return self.base.at({axis.key: axis.values[0] for axis in self.axes})

    @property
    def conditions(self) -> str:
        """Common conditions of all runs as a heading: scenario, architecture and others."""
        settings = self.first
        given = {**self.base.changes, **self.base.case}
        changes = [f'{key}={value}' for key, value in given.items()]
        swept = [axis.key for axis in self.axes]
        shared = {
            'architecture': settings.known.architecture,
            'wear_gain': f'wear gain {settings.case.wear_gain:g}',
            **shift_conditions(settings),
        }
        kept = ', '.join(text for key, text in shared.items() if key not in swept)
        return '; '.join(filter(None, (scenario_title(settings.scenario.name, changes), kept)))

    @property
    def varied(self) -> str:
        """Varied keys, for a heading."""
        return f'over {", ".join(axis.key for axis in self.axes)}'

    def __len__(self) -> int:
        """Return the number of runs."""
        return self.run_set.runs

    def table(self, runs: Sequence[ScoredRow]) -> pa.Table:
        """Return a row for each run, with the columns of a campaign."""
        return runs_table(schema_over({axis.key: axis.values for axis in self.axes}), runs)

    def runs(self) -> AbstractContextManager[Iterator[ScoredRow]]:
        """
        Carry out all runs on all cores as the iterator is consumed; see `scored_runs`.

        Those of the first controller come first.
        """
        return scored_runs(self.run_set, self.limits)


@dataclass(frozen=True)
class SweptRun:
    """A run at one point; other keys as in an entry of `scores.json`."""

    over: Mapping[str, Any]
    """Values by the keys of the axes."""
    conditions: Inline[RunConditions]
    scores: Inline[ScoresEntry]


@dataclass(frozen=True)
class SweptShift:
    """A gear shift at one point; other keys as in an entry of `scores.json`."""

    over: Mapping[str, Any]
    """Values by the keys of the axes."""
    conditions: Inline[RunConditions]
    shift: Inline[ShiftConditions]
    scores: Inline[ScoresEntry]


@dataclass(frozen=True)
class ImpossibleSweptRun:
    """A point at which no run can be built; other keys as in an entry of `scores.json`."""

    over: Mapping[str, Any]
    """Values by the keys of the axes."""
    conditions: Inline[NoConditions]
    scores: Inline[ScoresEntry]


SweptEntry = SweptRun | SweptShift | ImpossibleSweptRun


@dataclass(frozen=True)
class SweepDocument:
    """Document of `sweep --json`."""

    schema_version: int
    over: Sequence[Axis]
    controllers: Sequence[str]
    limits: Mapping[str, str | int]
    """Origin of the limits by which the runs were judged."""
    rows: Sequence[SweptEntry]
    """A row for each run."""


def sweep_document(sweep: Sweep, runs: Sequence[ScoredRow]) -> SweepDocument:
    """Return the document of `--json`: the axes, the limits, and a row per run."""
    return SweepDocument(
        SCHEMA_VERSION,
        sweep.axes,
        [controller_label(each) for each in sweep.controllers],
        sweep.limits.origin,
        [_row(run) for run in runs],
    )


def _row(run: ScoredRow) -> SweptEntry:
    entry = run_entry(run.scores)
    if isinstance(entry, UnreadableEntry):
        return ImpossibleSweptRun(run.varied, entry.conditions, entry.scores)
    if isinstance(entry, ShiftEntry):
        return SweptShift(run.varied, entry.conditions, entry.shift, entry.scores)
    return SweptRun(run.varied, entry.conditions, entry.scores)
