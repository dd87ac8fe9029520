# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No corner, wear gain of the range, or point inside the corners is worse than the worst one."""

import pytest
from corner_checks import (
    require_counted_unstable_corners,
    require_no_worse_corner,
    require_nothing_worse_inside,
)


@pytest.mark.parametrize('name', ['ls1', 'ls8', 'hinf1'])
def test_no_corner_and_wear_gain_is_worse(name: str) -> None:
    require_no_worse_corner(name, every=8, gains=(0.7, 0.9, 1.1, 1.3))


@pytest.mark.parametrize('name', ['ls1', 'ls8', 'hinf1'])
def test_nothing_inside_the_corners_is_worse(name: str) -> None:
    require_nothing_worse_inside(name, count=100)


@pytest.mark.parametrize('name', ['ls2', 'ls9', 'hinf2'])
def test_unstable_corners_are_those_with_an_unstable_pole_at_some_wear_gain(name: str) -> None:
    require_counted_unstable_corners(name)
