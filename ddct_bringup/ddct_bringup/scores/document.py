# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`scores.json`: scored runs as JSON, written and read."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Literal

from ddct_bringup.bag.run_facts import RunConditions, RunFacts, ShiftConditions
from ddct_bringup.metrics.catalogue import FIGURES, METRICS, OTHERS
from ddct_bringup.scores.scored_run import LEAST_IS_BOUND, ScoredRun
from ddct_bringup.verdict.limits import LimitResult, Limits
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.json_records import Inline, read_json
from ddct_plant.signals.gain_changes import GainChange

FACTS = tuple(each.name for each in fields(RunConditions))
"""Conditions of a run in its entry, in order."""


@dataclass(frozen=True)
class NoConditions:
    """Conditions of a run whose bag has none that can be read."""

    controller: None = None
    architecture: None = None
    scenario: None = None
    wear_gain: None = None
    mode: None = None
    seed: None = None


@dataclass(frozen=True)
class GainChangeEntry:
    """A gain that was changed in a run, in force from `time_s` in s on."""

    gain: str
    before: float
    after: float
    time_s: float

    def __post_init__(self) -> None:
        """Raise ParameterError for a time between two steps."""
        steps_in('time_s', self.time_s)


@dataclass(frozen=True)
class ScoresEntry:
    """Verdict, figures and metrics of a run."""

    valid: bool
    """Whether the run counts."""
    reason: str
    """Why it does not count; empty where it does."""
    state: str
    """What came of the engagement or the gear shift."""
    why: str
    """Values that decide the state; empty for a success."""
    figures: Mapping[str, float | bool | None]
    """What the run is judged by, by name, and `least_is_bound`."""
    metrics: Mapping[str, float | None]
    """The other metrics, by name."""
    limits: Sequence[LimitResult]
    """Metrics that have a limit."""
    null_reasons: Mapping[str, str]
    """Why a figure or metric has no value, by its name, and why `least_is_bound` is false."""
    fallbacks: int | None
    """
    How often a predictive controller had no solution and used its last plan; None for the others.
    """
    safe_state: str | None
    """In real time, which nodes entered their safe state and when; None in lock-step."""
    scenario_changes: Sequence[str] | None
    """What differs from the packaged scenario of the same name, as KEY=VALUE."""
    gain_changes: Sequence[GainChangeEntry]
    """Gains of the controller that were changed while it ran."""


@dataclass(frozen=True)
class RunEntry:
    """A run that is no gear shift."""

    bag: str
    """Bag or log of the run."""
    conditions: Inline[RunConditions]
    scores: Inline[ScoresEntry]


@dataclass(frozen=True)
class ShiftEntry:
    """A gear shift."""

    bag: str
    conditions: Inline[RunConditions]
    shift: Inline[ShiftConditions]
    scores: Inline[ScoresEntry]


@dataclass(frozen=True)
class UnreadableEntry:
    """A run without conditions that can be read."""

    bag: str
    conditions: Inline[NoConditions]
    scores: Inline[ScoresEntry]


Entry = RunEntry | ShiftEntry | UnreadableEntry


@dataclass(frozen=True)
class ScoresDocument:
    """Content of `scores.json`."""

    schema_version: Literal[4]
    limits: Mapping[str, str | int]
    """Origin of the limits by which the runs were judged."""
    runs: Sequence[Entry]


def scores_document(runs: Sequence[ScoredRun], limits: Limits) -> ScoresDocument:
    """Return the content of `scores.json` for runs that were judged by these limits."""
    return ScoresDocument(4, limits.origin, [run_entry(run) for run in runs])


def run_entry(run: ScoredRun) -> Entry:
    """Return the entry of one run; metrics of a gear shift only where it is one."""
    scores = _scores_entry(run)
    if run.facts is None:
        return UnreadableEntry(run.bag, NoConditions(), scores)
    conditions = RunConditions(**{name: getattr(run.facts, name) for name in FACTS})
    if isinstance(run.facts, RunFacts) and (shift := run.facts.of_shift):
        return ShiftEntry(run.bag, conditions, shift, scores)
    return RunEntry(run.bag, conditions, scores)


def _scores_entry(run: ScoredRun) -> ScoresEntry:
    shown = {each.key for each in METRICS.values() if run.is_shift or not each.of_shift}
    return ScoresEntry(
        valid=run.valid,
        reason=run.reason,
        state=run.state,
        why=run.why,
        figures=figures_entry(run),
        metrics={each.key: run.metrics[each.key] for each in OTHERS if each.key in shown},
        limits=run.limits,
        null_reasons={
            key: why
            for key, why in run.null_reasons.items()
            if key in shown or key == LEAST_IS_BOUND
        },
        fallbacks=run.fallbacks,
        safe_state=run.safe_state,
        scenario_changes=run.scenario_changes,
        gain_changes=[
            GainChangeEntry(each.gain, each.before, each.after, each.time_s)
            for each in run.gain_changes
        ],
    )


def figures_entry(run: ScoredRun) -> Mapping[str, float | bool | None]:
    """Return the figures of a run by key; those of a gear shift only where it is one."""
    figures: dict[str, float | bool | None] = {
        each.key: run.metrics[each.key] for each in FIGURES if run.is_shift or not each.of_shift
    }
    return {**figures, LEAST_IS_BOUND: run.least_is_bound}


def read_scores(path: str | Path) -> list[ScoredRun]:
    """Return the runs in a `scores.json`; raise DdctError for a file that is none."""
    advice = 'score the bags again with ddct score'
    content = read_json(ScoresDocument, Path(path), advice=advice)
    return [_run_of(entry) for entry in content.runs]


def _run_of(entry: Entry) -> ScoredRun:
    found, conditions = entry.scores, entry.conditions
    bound = found.figures.get(LEAST_IS_BOUND)
    return ScoredRun(
        bag=entry.bag,
        facts=None if isinstance(conditions, NoConditions) else conditions,
        valid=found.valid,
        reason=found.reason,
        metrics={key: {**found.metrics, **found.figures}.get(key) for key in METRICS},
        state=found.state,
        why=found.why,
        limits=tuple(found.limits),
        fallbacks=found.fallbacks,
        safe_state=found.safe_state,
        scenario_changes=None if found.scenario_changes is None else tuple(found.scenario_changes),
        gain_changes=tuple(
            GainChange(each.gain, each.before, each.after, steps_in('time_s', each.time_s))
            for each in found.gain_changes
        ),
        null_reasons=found.null_reasons,
        least_is_bound=None if bound is None else bool(bound),
    )
