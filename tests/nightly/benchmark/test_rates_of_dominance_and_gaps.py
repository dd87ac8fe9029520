# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Over many benchmarks, copies are dominated, and memorisers flagged, at the stated rates."""

import pytest
from made_benchmarks import (
    HALF_OF_FAILURES,
    HONEST,
    MEMORISERS,
    draws_with_a_dominated_copy,
    flagged_draws,
)

SEEDS = (101, 102, 103, 104, 105)
"""Fixed before the rates were known."""


def test_any_of_thirty_copies_is_dominated_in_at_most_5_percent_of_draws() -> None:
    """Bonferroni's bound is 5 %; of 1000 draws 5 % are 50, with a standard deviation of 7."""
    draws = 200
    found = sum(draws_with_a_dominated_copy(draws, seed) for seed in SEEDS)
    assert found <= 0.05 * draws * len(SEEDS)


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('failing', [0.1, 0.2])
def test_memorisers_are_flagged_in_nine_of_ten_draws(seed: int, failing: float) -> None:
    draws = 200
    found = flagged_draws(draws, seed, MEMORISERS, failing)
    assert {kind: flagged for kind, flagged in found.items() if flagged < 0.9 * draws} == {}


@pytest.mark.parametrize('seed', SEEDS)
@pytest.mark.parametrize('failing', [0.001, 0.1, 0.2])
def test_honest_controllers_are_flagged_in_at_most_8_percent(seed: int, failing: float) -> None:
    draws = 400
    assert flagged_draws(draws, seed, [HONEST], failing)[HONEST] <= 0.08 * draws


@pytest.mark.parametrize('seed', SEEDS)
def test_one_that_fails_in_5_percent_for_10_is_flagged_in_half_of_the_draws(seed: int) -> None:
    """As the page says of what stays open."""
    draws = 200
    found = flagged_draws(draws, seed, [HALF_OF_FAILURES], failing=0.1)[HALF_OF_FAILURES]
    assert 0.35 * draws <= found <= 0.65 * draws
