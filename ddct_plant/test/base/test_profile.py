# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A profile has one value at a time, to the last bit, whoever asks for it."""

import numpy as np
import pytest

from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.engine import Engine, TorqueProfile
from ddct_plant.models.load import BrakeProfile

STEPS = 300


@pytest.mark.parametrize('seed', range(20))
def test_the_demand_of_an_engine_is_the_value_of_its_profile_to_the_last_bit(seed):
    random = np.random.default_rng(seed)
    points = 1 + seed % 5
    times = np.sort(random.choice(STEPS, points, replace=False)) / 100.0 + random.uniform(0, 0.009)
    torques = random.uniform(0.0, 300.0, points)
    profile = TorqueProfile(tuple(times.tolist()), tuple(torques.tolist()))
    engine = Engine(profile)
    demands = [engine.demand(step) for step in range(STEPS)]
    assert demands == [profile.at(time_of_step(step)) for step in range(STEPS)]
    assert demands == profile.over(np.arange(STEPS) / 100.0).tolist()
    assert demands == pytest.approx(np.interp(np.arange(STEPS) / 100.0, times, torques), rel=1e-12)


def test_a_profile_is_linear_between_its_points_and_the_ends_hold():
    brake = BrakeProfile((0.5, 1.0, 1.5), (100.0, 300.0, 0.0))
    times = [0.0, 0.5, 0.625, 1.0, 1.25, 1.5, 9.0]
    assert [brake.at(time) for time in times] == [100.0, 100.0, 150.0, 300.0, 150.0, 0.0, 0.0]
    assert all(type(brake.at(time)) is float for time in times)
