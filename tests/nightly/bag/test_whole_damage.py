# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Six hundred damages of bags: flipped bits, zeroed blocks and cuts."""

import pytest
from support.damages import tried_damages

from ddct_bringup.bag.reader import mcap_of


@pytest.mark.parametrize('clutch', ['linear', 'stick_slip'])
@pytest.mark.parametrize('seed', [1, 2, 3])
def test_whatever_is_damaged_a_bag_is_refused_or_the_beginning_of_the_true_one(
    bags, make_trajectory, clutch, seed
):
    run = make_trajectory(150, clutch=clutch)
    counts = tried_damages(mcap_of(bags.write(run, clutch=clutch)), run, 600, seed)
    assert counts['refused'] > 350
    assert counts['unfinished'] > 100
