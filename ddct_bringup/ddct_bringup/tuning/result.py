# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of a tuning, `front.json`: the front, its held-out figures, sensitivity, convergence."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.benchmark.comparison import gaps_between
from ddct_bringup.benchmark.result_types import Gap
from ddct_bringup.benchmark.statistics.case_figures import FIGURES
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.rows import STATE, Row
from ddct_bringup.tuning.front import best_of, front_of
from ddct_bringup.tuning.sensitivity import ParameterEffect, effects_on
from ddct_bringup.tuning.specification.goals import MINIMISE, RunColumns
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.trial import FEASIBLE, Trial
from ddct_bringup.tuning.tuned_files import trial_file
from ddct_bringup.tuning.tuned_names import BEST
from ddct_bringup.tuning.tuning import Tuning

SCHEMA_VERSION = 1
"""Schema version of `front.json`."""


@dataclass(frozen=True)
class Figures:
    """Objectives and constraints of one controller on one set of cases."""

    objectives: Mapping[str, float | None]
    constraints: Mapping[str, float | None]
    engaged: float
    """Share of the runs that engage."""
    runs: int
    keeps_constraints: bool


@dataclass(frozen=True)
class FrontEntry:
    """A trial on the front, or the first one."""

    number: int
    parameters: Mapping[str, float]
    file: str | None
    """Controller file in the folder; None for a trial that has none."""
    development: Figures
    held_out: Figures | None
    """None for a trial that did not run on the held-out cases."""


@dataclass(frozen=True)
class GoalEntry:
    """An objective or a constraint."""

    name: str
    title: str
    unit: str
    form: str
    sense: str
    limit: float | None
    """Limit of a constraint; None for an objective."""


@dataclass(frozen=True)
class ParameterRange:
    """Range in which a parameter was searched."""

    low: float
    high: float
    scale: str
    """LINEAR or LOG, as in `Parameter`."""


@dataclass(frozen=True)
class TuningResult:
    """Content of `front.json`."""

    schema_version: int
    controller: str
    parameters: Mapping[str, ParameterRange]
    objectives: list[GoalEntry]
    constraints: list[GoalEntry]
    trials: int
    states: Mapping[str, int]
    reasons: Mapping[str, int]
    """Number of trials by what made them infeasible or ended them."""
    runs: int
    """Number of runs of the trials that were computed."""
    all_runs: int
    """Number of runs without trials that were ended."""
    cases: int
    held_out_seed: int
    best: int
    best_file: str
    front: list[FrontEntry]
    before: FrontEntry | None
    """The first trial, if it has the values from before the tuning."""
    gaps: list[Gap]
    """Differences of the best trial between development and held-out cases, tested."""
    sensitivity: Mapping[str, list[ParameterEffect]]
    convergence: Mapping[str, list[float | None]]
    """By objective the best feasible value after each trial, None before the first."""


def result_of(
    tuning: Tuning, trials: Sequence[Trial], held_out: Mapping[int, Trial], seed: int
) -> TuningResult:
    """Return the result; `held_out` has the trials of the held-out cases, `seed` drew those."""
    spec = tuning.spec
    front = front_of(trials, spec)
    best = best_of(front, spec)
    return TuningResult(
        schema_version=SCHEMA_VERSION,
        controller=tuning.controller.name,
        parameters={
            each.name: ParameterRange(each.low, each.high, each.scale) for each in spec.parameters
        },
        objectives=_goal_entries(spec, constraints=False),
        constraints=_goal_entries(spec, constraints=True),
        trials=len(trials),
        states=dict(sorted(Counter(each.state for each in trials).items())),
        reasons=dict(Counter(each.reason for each in trials if each.reason).most_common()),
        runs=sum(len(each.rows) for each in trials),
        all_runs=len(trials) * len(tuning.cases),
        cases=len(tuning.cases),
        held_out_seed=seed,
        best=best.number,
        best_file=BEST,
        front=[_entry(spec, each, held_out.get(each.number)) for each in front],
        before=_entry(spec, trials[0], held_out.get(0)) if tuning.present else None,
        gaps=gaps_between(*(_columns(each.rows) for each in (best, held_out[best.number]))),
        sensitivity={goal.name: effects_on(goal, trials, spec) for goal in spec.objectives},
        convergence=_convergence(spec, trials),
    )


def _goal_entries(spec: TuningSpec, *, constraints: bool) -> list[GoalEntry]:
    pairs = (
        [(each.goal, each.title, each.limit) for each in spec.constraints]
        if constraints
        else [(each, each.title, None) for each in spec.objectives]
    )
    return [
        GoalEntry(
            name=goal.name,
            title=title,
            unit=goal.quantity.unit,
            form=goal.quantity.form,
            sense=goal.sense,
            limit=limit,
        )
        for goal, title, limit in pairs
    ]


def _entry(spec: TuningSpec, trial: Trial, held_out: Trial | None) -> FrontEntry:
    return FrontEntry(
        number=trial.number,
        parameters=dict(trial.values),
        file=trial_file(trial.number) if held_out else None,
        development=_figures(spec, trial),
        held_out=_figures(spec, held_out) if held_out else None,
    )


def _figures(spec: TuningSpec, trial: Trial) -> Figures:
    entry = trial.entry(spec)
    columns = RunColumns.of(trial.rows, (), 0)
    checked = Trial(trial.number, trial.values, trial.rows, trial.further)
    return Figures(
        objectives=entry.objectives,
        constraints=entry.constraints,
        engaged=float(np.mean(columns.engaged)) if len(trial.rows) else 0.0,
        runs=len(trial.rows),
        keeps_constraints=checked.checked(spec, len(trial.rows)).state == FEASIBLE,
    )


def _columns(rows: Sequence[Row]) -> dict[str, np.ndarray]:
    """Return the columns that decide about gaps, (runs,) each."""
    names = [name for figure in FIGURES for name in figure.columns]
    return {
        'valid': np.array([row['valid'] for row in rows], dtype=bool),
        **{
            name: np.array([row[name] for row in rows], dtype=object)
            for name in (STATE, SCENARIO)
            if name in rows[0]
        },
        **{name: np.array([row[name] for row in rows], dtype=float) for name in names},
    }


def _convergence(spec: TuningSpec, trials: Sequence[Trial]) -> dict[str, list[float | None]]:
    found: dict[str, list[float | None]] = {}
    for goal in spec.objectives:
        better = min if goal.sense == MINIMISE else max
        best: float | None = None
        found[goal.name] = []
        for each in trials:
            value = each.estimate(goal, spec) if each.state == FEASIBLE else None
            if value is not None:
                best = value if best is None else better(best, value)
            found[goal.name].append(best)
    return found
