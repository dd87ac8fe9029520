# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics, states and limits of many runs that are not recorded."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.stacks import stacked
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.shift.course import torque_phase_ends
from ddct_bringup.metrics.values import raw_metrics, rows_of, window_steps
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.state import states_of
from ddct_plant.scenario.settings import RunSettings


def stacked_results(
    runs: Sequence[RunSettings], trajectory: Trajectory, limits: Limits
) -> list[ScoredRun]:
    """
    Return the results of runs of one length, control start and score window.

    `trajectory` is a stack of these runs in which all values are finite; `phase_events` are an
    array of objects, (R, N+1). All runs are valid, and have neither a bag nor facts, which the
    caller has. The times of updates are None.
    """
    if not trajectory.shift:
        return _results(runs, trajectory, limits)
    ends = torque_phase_ends(trajectory, runs[0].scenario.control_start_step)
    results: dict[int, ScoredRun] = {}
    for end in np.unique(ends):
        group = np.flatnonzero(ends == end).tolist()
        alike = part_of_stack(trajectory, group)
        results |= zip(group, _results([runs[each] for each in group], alike, limits), strict=True)
    return [results[index] for index in range(len(runs))]


def _results(
    runs: Sequence[RunSettings], trajectory: Trajectory, limits: Limits
) -> list[ScoredRun]:
    """Return the results of runs whose torque phases also end at the same step."""
    scenario = runs[0].scenario
    plants = [JudgedPlant.of(run.scenario) for run in runs]
    engagement = Engagement(
        trajectory,
        scenario.control_start_step,
        window_steps(scenario.score_window_s),
        scenario.steps,
        stacked_plants(plants),
        RunTiming(),
    )
    metrics = rows_of(raw_metrics(engagement), len(runs))
    speeds = trajectory.engine_speed[..., -1].tolist()
    ends = [run.scenario.end_cause(speed) for run, speed in zip(runs, speeds, strict=True)]
    states = states_of(engagement, ends, limits.rules)
    results = []
    for run, plant, row, state in zip(runs, plants, metrics, states, strict=True):
        beside = limits.beside(row, run.scenario.name, plant)
        results.append(ScoredRun('', None, True, '', row, *state, beside))
    return results


def stacked_plants(plants: Sequence[JudgedPlant]) -> Any:
    """Return one plant whose parameters are those of many plants, (R,) each."""
    return JudgedPlant(**vars(stacked(plants)))


def part_of_stack(stack: Trajectory, index: Any) -> Trajectory:
    """Return one run of a stack for an integer index, or a smaller stack."""
    # The samples of each run stay contiguous, so that all are summed in the order of one run.
    return Trajectory(
        {name: np.ascontiguousarray(values[index]) for name, values in stack.signals.items()}
    )


def until(stack: Trajectory, step: int) -> Trajectory:
    """Return the runs of a stack up to a step."""
    cut = slice(step + 1)
    return Trajectory({name: values[:, cut] for name, values in stack.signals.items()})
