# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics, state and limits of runs with sticking plates in a stack are those of each alone."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.results import stacked_results
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

Case = tuple[str, str, float, str]
"""Controller, scenario, wear gain and handover of a run."""
Run = tuple[RunSettings, Trajectory]
LAUNCHES: list[Case] = [
    ('ls8', 'launch', 1.0, 'adaptive'),
    ('ls8', 'launch', 0.6, 'adaptive'),
    ('mpc3', 'launch', 0.3, 'adaptive'),
    ('ls8', 'launch_hill', 1.0, 'adaptive'),
]
RELEASES: list[Case] = [
    ('mpc3', 'thesis_sticking', 1.0, 'adaptive'),
    ('mpc3', 'thesis_sticking', 0.7, 'adaptive'),
    ('pi', 'thesis_sticking', 1.3, 'adaptive'),
]
STALLED: list[Case] = [('ls8', 'launch', 3.0, 'adaptive'), ('ls8', 'launch', 3.0, 'adaptive')]
COMMANDED: list[Case] = [
    ('torque_estimator', 'launch', 1.0, 'adaptive'),
    ('torque_estimator', 'launch', 0.3, 'adaptive'),
]
SHIFTS: list[Case] = [
    ('ls8', 'upshift', 1.0, 'adaptive'),
    ('pi', 'upshift', 0.2, 'timed'),
    ('ls8', 'upshift', 0.4, 'slip'),
    ('ls8', 'upshift', 2.5, 'timed'),
]
STACKS = [LAUNCHES, RELEASES, STALLED, COMMANDED, SHIFTS]
NAMES = ['launches', 'releases', 'stalled', 'commanded', 'shifts']


@cache
def run_of(controller: str, scenario: str, wear_gain: float, handover: str) -> Run:
    known = KnownSettings(load_scenario(scenario), handover=handover)
    settings = RunSettings(known, CaseSettings(wear_gain=wear_gain))
    return settings, run_headless(settings, controller)


def in_a_stack(runs: Sequence[Run]) -> list[ScoredRun]:
    """Return the scores of runs from one stack of the signals that all of them have."""
    trajectories = [trajectory for _, trajectory in runs]
    names = set.intersection(*(set(each.signals) for each in trajectories)) - {'status'}
    stack = {name: _stacked([each.signals[name] for each in trajectories]) for name in names}
    return stacked_results(
        [settings for settings, _ in runs], Trajectory(stack), packaged_limits()
    )


def _stacked(values: Sequence[Any]) -> np.ndarray:
    """Return the values of a signal, (R, N+1) or more; events are objects."""
    if isinstance(values[0], np.ndarray):
        return np.stack(values)
    stack = np.empty((len(values), len(values[0])), dtype=object)
    for row, periods in zip(stack, values, strict=True):
        for step, events in enumerate(periods):
            row[step] = events
    return stack


@cache
def alone(*case: Any) -> ScoredRun:
    settings, trajectory = run_of(*case)
    recording = recording_in_memory(settings, 'any', trajectory)
    return score_run(recording, '', packaged_limits(), RunTiming())


def judged(run: ScoredRun) -> tuple[object, ...]:
    """Return what a stack gives of a run, with the type of each value."""
    kinds = {name: type(value) for name, value in run.metrics.items()}
    return run.valid, run.metrics, kinds, run.state, run.why, run.limits


@pytest.mark.parametrize('cases', STACKS, ids=NAMES)
def test_each_run_of_a_stack_is_judged_to_the_last_bit_as_alone(cases):
    found = in_a_stack([run_of(*case) for case in cases])
    for case, ours in zip(cases, found, strict=True):
        assert judged(ours) == judged(alone(*case))


def test_the_stacks_have_runs_of_several_states():
    states = {alone(*case).state for cases in STACKS for case in cases}
    assert states == {'engaged', 'late', 'not_engaged', 'stalled', 'tied_up'}
    releases = [alone(*case).metrics['releases'] for case in RELEASES]
    assert max(releases) > 0


@pytest.mark.parametrize('runs', [1, 2, 3, 33])
@pytest.mark.parametrize('cases', [LAUNCHES, SHIFTS], ids=['launches', 'shifts'])
def test_it_does_not_depend_on_the_number_of_runs_in_the_stack(cases, runs):
    chosen = [run_of(*cases[place % len(cases)]) for place in range(runs)]
    expected = [judged(each) for each in in_a_stack([run_of(*case) for case in cases])]
    found = [judged(each) for each in in_a_stack(chosen)]
    assert found == [expected[place % len(cases)] for place in range(runs)]
