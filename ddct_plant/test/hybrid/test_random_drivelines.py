# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Random drivelines move as another integration has it: a sample of the nightly gate."""

import pytest
from driveline_reference import compared
from random_drivelines import RandomDriveline
from samples import sampled

pytestmark = pytest.mark.slow


@pytest.mark.parametrize('first', sampled(range(4), every=2))
def test_a_sample_of_drivelines_has_the_events_and_speeds_of_another_method(first):
    """Those with 1 + `first` elements."""
    indices = range(first, 2000, 400)
    found = {index: compared(index) for index in indices}
    assert all(RandomDriveline(index).elements == 1 + first for index in indices)
    assert {i: each for i, each in found.items() if not (each.agrees or each.apart)} == {}
    assert sum(each.events for each in found.values()) >= 20


def test_a_driveline_whose_element_holds_nothing_at_no_capacity_goes_on():
    """A torque of rounding let an element neither stick nor slip."""
    assert compared(1106).agrees
