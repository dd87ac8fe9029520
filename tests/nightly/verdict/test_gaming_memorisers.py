# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers that remember the development cases of the benchmark are worse in held-out ones."""

import pytest
from support.gaming_runs import DEVELOPMENT_SEED, HELD_OUT_SEED, gaming_file, runs_in_cases

from ddct_bringup.evaluation.held_out_gaps import Gap, gaps_of

SAMPLES = 30
"""All samples of each scenario: fewer do not show one that remembers wear gains alone."""


def gaps_between_seeds(chosen: str) -> tuple[Gap, ...]:
    development, held_out = (
        runs_in_cases(chosen, seed, SAMPLES) for seed in (DEVELOPMENT_SEED, HELD_OUT_SEED)
    )
    return gaps_of(
        (development.figures, development.scenarios), (held_out.figures, held_out.scenarios)
    )


def least_p_value(gaps: tuple[Gap, ...]) -> float:
    return min(gap.p_value for gap in gaps if gap.p_value is not None)


@pytest.fixture(scope='module')
def gaps_of_ls8() -> tuple[Gap, ...]:
    """Return the gaps of the controller that both memorisers are in cases that are new to them."""
    return gaps_between_seeds('ls8')


@pytest.mark.parametrize('name', ['remember_cases', 'remember_gains'])
def test_a_controller_that_remembers_the_development_cases_is_flagged(
    name: str, gaps_of_ls8: tuple[Gap, ...]
) -> None:
    gaps = gaps_between_seeds(gaming_file(name))
    assert any(gap.differs for gap in gaps)
    assert least_p_value(gaps) < least_p_value(gaps_of_ls8)


def test_the_controller_that_they_are_elsewhere_is_not_flagged(
    gaps_of_ls8: tuple[Gap, ...],
) -> None:
    assert not any(gap.differs for gap in gaps_of_ls8)
