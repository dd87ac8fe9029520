# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Objectives and constraints: their statistics, and what is certain before all runs are done."""

import numpy as np
import pytest

from ddct_bringup.tuning.specification.goals import (
    ENGAGED,
    MAXIMISE,
    MINIMISE,
    STATISTICS,
    Constraint,
    Goal,
    RunColumns,
    Sense,
)

NAME = 'peak_jerk_m_s3'


def columns(values: np.ndarray, engaged: np.ndarray, left: int = 0) -> RunColumns:
    return RunColumns(engaged, {NAME: values}, left)


@pytest.mark.parametrize(
    ('statistic', 'sense', 'expected'),
    [
        ('mean', MINIMISE, 3.0),
        ('median', MINIMISE, 2.0),
        ('worst', MINIMISE, 7.0),
        ('worst', MAXIMISE, 1.0),
        ('p95', MINIMISE, 6.4),
        ('p5', MAXIMISE, 1.1),
    ],
)
def test_a_statistic_is_over_the_engaged_runs_with_a_value(
    statistic: str, sense: Sense, expected: float
) -> None:
    values = np.array([1.0, 2.0, 7.0, 100.0, np.nan, 2.0])
    engaged = np.array([True, True, True, False, True, True])
    found = Goal(NAME, statistic, sense).value(columns(values, engaged))
    if statistic == 'mean':
        assert found == 3.0
    else:
        assert found == pytest.approx(expected, abs=0.3)


def test_without_a_value_there_is_none() -> None:
    nothing = columns(np.array([1.0]), np.array([False]))
    assert Goal(NAME, 'mean', MINIMISE).value(nothing) is None


@pytest.mark.parametrize('sense', [MINIMISE, MAXIMISE])
@pytest.mark.parametrize('statistic', STATISTICS)
def test_no_rest_of_the_runs_is_better_than_the_bound(statistic: str, sense: Sense) -> None:
    random = np.random.default_rng(1)
    goal = Goal(NAME, statistic, sense)
    for _ in range(200):
        runs = int(random.integers(2, 12))
        done = int(random.integers(1, runs))
        values = random.lognormal(size=runs)
        values[random.random(runs) < 0.2] = np.nan
        engaged = random.random(runs) < 0.7
        bound = goal.value(columns(values[:done], engaged[:done], runs - done))
        final = goal.value(columns(values, engaged))
        assert bound is not None
        if final is not None:
            assert bound <= final + 1e-12 if sense == MINIMISE else bound >= final - 1e-12


def test_the_share_of_engaged_runs_counts_all_runs() -> None:
    goal = Goal(ENGAGED, '', MAXIMISE)
    engaged = np.array([True, False, False])
    assert goal.value(RunColumns(engaged, {}, 0)) == pytest.approx(1 / 3)
    assert goal.value(RunColumns(engaged, {}, 1)) == pytest.approx(2 / 4)


def test_a_limit_may_be_met_exactly_and_a_missing_value_breaks_it() -> None:
    most = Constraint(Goal(NAME, 'worst', MINIMISE), 5.0)
    least = Constraint(Goal(ENGAGED, '', MAXIMISE), 0.9)
    assert [most.breaks(value) for value in (5.0, 5.1, None)] == [False, True, True]
    assert [least.breaks(value) for value in (0.9, 0.89, None)] == [False, True, True]
