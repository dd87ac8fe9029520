# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Random runs over all controllers lie on the right side of their floors."""

from support.random_runs import outcomes

RUNS = 24


def test_random_runs_satisfy_their_constraints_and_lie_above_their_floors() -> None:
    done = list(outcomes(RUNS, seed=7))
    assert [each for each in done if each.wrong] == []
    assert sum(each.covered for each in done) >= RUNS // 5


def test_random_shifts_satisfy_their_constraints_and_lie_above_their_floors() -> None:
    done = list(outcomes(RUNS, seed=7, shifts=True))
    assert [each for each in done if each.wrong] == []
    assert sum(each.covered for each in done) >= RUNS // 4
