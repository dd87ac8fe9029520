# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sample of the runs with the second car; `tests/nightly/run` has all drives and controllers."""

import itertools

import pytest
from samples import sampled
from second_car import DRIVES, scored

from ddct_bringup.verdict.state import ENGAGED

SAMPLE = ('launch', 'launch_hill', 'tip_in', 'upshift', 'upshift_2_3')


@pytest.mark.slow
def test_there_are_ten_drives_for_every_car():
    assert len(DRIVES) == 10
    assert {*SAMPLE} < {*DRIVES}


@pytest.mark.slow
@pytest.mark.parametrize(
    ('drive', 'controller'),
    sampled(itertools.product(SAMPLE, ['least_jerk', 'hinf_sampled', 'lqi']), every=2),
)
def test_controllers_that_suit_every_car_engage(drive, controller):
    run = scored(drive, controller)
    assert (run.valid, run.state) == (True, ENGAGED), run.why
    if controller == 'least_jerk':
        assert run.metrics['releases'] == 0
