# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A random number depends on root seed, key and case, and on nothing else."""

import numpy as np
import pytest

from ddct_bringup.campaign.draws import run_seeds, uniforms


def uniform(root: int, key: str, case: int) -> float:
    return uniforms(root, key, range(case, case + 1))[0]


KEPT = [0.42601729733199983, 0.4218546285402463, 469517763]


def test_numbers_are_those_of_philox_whatever_the_version_of_numpy() -> None:
    found = [uniform(7, 'wear_gain', 0), uniform(7, 'wear_gain', 12345), run_seeds(7, range(1))[0]]
    assert found == KEPT


@pytest.mark.parametrize('other', [(8, 'wear_gain', 3), (7, 'gear', 3), (7, 'wear_gain', 4)])
def test_another_root_key_or_case_gives_another_number(other) -> None:
    assert uniform(7, 'wear_gain', 3) != uniform(*other)


def test_numbers_of_cases_and_of_keys_are_uniform_and_not_related() -> None:
    drawn = np.array([[uniform(1, key, case) for case in range(2000)] for key in ('a', 'b')])
    assert drawn.min() > 0.0
    assert drawn.max() < 1.0
    counts = np.histogram(drawn[0], bins=10, range=(0.0, 1.0))[0]
    assert counts.min() > 150
    assert abs(np.corrcoef(drawn)[0, 1]) < 0.08
    assert abs(np.corrcoef(drawn[0][1:], drawn[0][:-1])[0, 1]) < 0.08


def test_the_numbers_of_many_cases_are_those_of_each_case_alone() -> None:
    cases = range(1234, 1334)
    assert uniforms(7, 'wear_gain', cases) == [uniform(7, 'wear_gain', case) for case in cases]
    assert run_seeds(7, cases) == [run_seeds(7, range(case, case + 1))[0] for case in cases]
