# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of a tuning, `front.json`: the front, its held-out figures, sensitivity, convergence."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.evaluation.held_out_gaps import Gap
from ddct_bringup.evaluation.share import Share
from ddct_bringup.evaluation.summarise import gaps_between
from ddct_bringup.tuning.front import best_of
from ddct_bringup.tuning.specification.goals import RunColumns
from ddct_bringup.tuning.specification.parameters import LOG
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.study import TuningStudy
from ddct_bringup.tuning.trial import FEASIBLE, Trial
from ddct_bringup.tuning.tuned_files import trial_file
from ddct_bringup.tuning.tuned_names import BEST
from ddct_bringup.tuning.tuning import Tuning

SCHEMA_VERSION = 3
"""Schema version of `front.json`."""
_AT_END = 0.01
"""Share of a range at each end in which a value counts as at the end."""


@dataclass(frozen=True)
class Figures:
    """Objectives and constraints of one controller on one set of cases."""

    objectives: Mapping[str, float | None]
    constraints: Mapping[str, float | None]
    engaged: Share
    """Engaged runs among all."""
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

    def end_near(self, value: float) -> str:
        """Return the end of the range within 1 % of which a value is, as text; '' for none."""
        low, high, at = self.low, self.high, value
        if self.scale == LOG:
            low, high, at = (math.log(each) for each in (low, high, value))
        if at - low <= _AT_END * (high - low):
            return f'its lowest, {self.low:g}'
        return f'its highest, {self.high:g}' if high - at <= _AT_END * (high - low) else ''


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
    gaps: tuple[Gap, ...]
    """Differences of the best trial between development and held-out cases, tested."""
    importances: Mapping[str, Mapping[str, float]]
    """By objective how much each parameter decides it, the most first; their sum is 1."""


def result_of(
    tuning: Tuning,
    study: TuningStudy,
    trials: Sequence[Trial],
    held_out: Mapping[int, Trial],
    seed: int,
) -> TuningResult:
    """Return the result; `held_out` has the trials of the held-out cases, `seed` drew those."""
    spec = tuning.spec
    front = [trials[number] for number in study.front()]
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
        gaps=gaps_between(best.rows, held_out[best.number].rows),
        importances={
            goal.name: study.importances(place) for place, goal in enumerate(spec.objectives)
        },
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
    engaged = RunColumns.of(trial.rows, (), 0).engaged
    checked = Trial(trial.number, trial.values, trial.rows, trial.further)
    return Figures(
        objectives={each.name: trial.estimate(each, spec) for each in spec.objectives},
        constraints={each.goal.name: trial.estimate(each.goal, spec) for each in spec.constraints},
        engaged=Share(int(np.sum(engaged)), len(engaged)),
        keeps_constraints=checked.checked(spec, len(trial.rows)).state == FEASIBLE,
    )
