# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics, criteria and verdicts of many runs that are not recorded."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.stacks import stacked
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.metric import finite
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.values import (
    existing,
    raw_criteria,
    raw_metrics,
    rows_of,
    window_steps,
)
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.state import slip_state
from ddct_bringup.verdict.verdict import judged_traction, verdict_of
from ddct_plant.scenario.settings import RunSettings


def stacked_results(
    runs: Sequence[RunSettings], trajectory: Trajectory, limits: Limits
) -> list[ScoredRun]:
    """
    Return the results of runs of one length, control start and score window.

    `trajectory` is a stack of these runs in which all values are finite. All are valid, and have
    neither a bag nor facts, which the caller has. The times of updates are None.
    """
    scenario = runs[0].scenario
    start = scenario.control_start_step
    plants = [JudgedPlant.of(run.scenario) for run in runs]
    engagement = Engagement(
        trajectory,
        start,
        window_steps(scenario.score_window_s),
        limits.rules.engagements_a_day,
        stacked_plants(plants),
        RunTiming(),
    )
    metrics = raw_metrics(engagement)
    driving = np.asarray(engagement.driving_acceleration).tolist()
    by_metric = rows_of(metrics, len(runs))
    by_criterion = rows_of(raw_criteria(engagement, metrics), len(runs))
    by_existence = rows_of(existing(engagement), len(runs))
    results = []
    for index, (run, plant) in enumerate(zip(runs, plants, strict=True)):
        state = slip_state(part_of_stack(trajectory, index), start, limits.rules, plant)
        verdict = verdict_of(
            state,
            by_criterion[index],
            limits,
            run.scenario.name,
            exists=by_existence[index],
            traction=judged_traction(finite(driving[index]), plant, limits),
        )
        results.append(ScoredRun('', None, True, '', by_metric[index], verdict))
    return results


def stacked_plants(plants: Sequence[JudgedPlant]) -> Any:
    """Return one plant whose parameters are those of many plants, (R,) each."""
    return JudgedPlant(**vars(stacked(plants)))


def part_of_stack(stack: Trajectory, index: Any) -> Trajectory:
    """Return one run of a stack for an integer index, or a smaller stack."""
    return Trajectory({name: values[index] for name, values in stack.signals.items()})
