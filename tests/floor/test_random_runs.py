# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sample of random runs over all controllers lies on the right side of its floors."""

import numpy as np
import pytest
from support.random_runs import outcome, outcomes

RUNS = 5
"""More of them, and shifts, are in tests/nightly/floor."""


@pytest.mark.slow
def test_random_runs_satisfy_their_constraints_and_lie_above_their_floors() -> None:
    done = list(outcomes(RUNS, seed=7))
    assert [each for each in done if each.wrong] == []
    assert sum(each.covered for each in done) >= 1


def test_a_program_on_which_an_interior_point_method_of_highs_never_ended_gives_a_floor() -> None:
    found = outcome(np.random.default_rng((1, 3875)), 3875)
    assert found.covered
    assert not found.wrong


def test_a_program_whose_solver_ended_with_huge_multipliers_gives_a_floor() -> None:
    """Their rounding alone was a bound of 262313 m/s^3."""
    found = outcome(np.random.default_rng((1, 359)), 359, shifts=True)
    assert found.covered
    assert not found.wrong
