# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics, states and limits of many runs that are not recorded."""

from collections.abc import Sequence
from typing import Any

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.stacks import stacked
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.values import raw_metrics, rows_of, window_steps
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.state import state_of
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
    plants = [JudgedPlant.of(run.scenario) for run in runs]

    def engagement_of(part: Trajectory, plant: JudgedPlant) -> Engagement:
        return Engagement(
            part,
            scenario.control_start_step,
            window_steps(scenario.score_window_s),
            scenario.steps,
            plant,
            RunTiming(),
        )

    metrics = rows_of(raw_metrics(engagement_of(trajectory, stacked_plants(plants))), len(runs))
    results = []
    for index, (run, plant) in enumerate(zip(runs, plants, strict=True)):
        engagement = engagement_of(part_of_stack(trajectory, index), plant)
        state = state_of(engagement, None, limits.rules)
        beside = limits.beside(metrics[index], run.scenario.name, plant)
        results.append(ScoredRun('', None, True, '', metrics[index], *state, beside))
    return results


def stacked_plants(plants: Sequence[JudgedPlant]) -> Any:
    """Return one plant whose parameters are those of many plants, (R,) each."""
    return JudgedPlant(**vars(stacked(plants)))


def part_of_stack(stack: Trajectory, index: Any) -> Trajectory:
    """Return one run of a stack for an integer index, or a smaller stack."""
    return Trajectory({name: values[index] for name, values in stack.signals.items()})
