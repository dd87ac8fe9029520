# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engines of many runs give the torque of each one alone, at speeds that no driveline reaches."""

import numpy as np
import pytest

from ddct_bringup.batch.plant.engines import LimitedEngines
from ddct_plant.models.engine_limits import EngineLimits, LimitedEngine


def test_engines_within_their_limits_are_those_alone():
    """The speeds jump between idle control, the rev limiter, and now and then a stall."""
    random = np.random.default_rng(48)
    runs, steps = 12, 60
    limits = [
        EngineLimits(idle_rad_s=idle, idle_integral_n_m=random.uniform(5.0, 300.0))
        for idle in random.uniform(80.0, 110.0, runs)
    ]
    speeds = random.choice([60.0, 100.0, 400.0, 675.0, 700.0], size=(steps, runs))
    speeds += random.uniform(-7.0, 7.0, size=(steps, runs))
    speeds[40, ::4], speeds[50, 1::4], speeds[55, 1::4] = 50.0, 790.0, 50.0
    requests = random.uniform(-80.0, 300.0, size=(steps, runs))
    together, alone = LimitedEngines(limits), [LimitedEngine(each) for each in limits]
    for request, speed in zip(requests, speeds, strict=True):
        expected = [
            engine.deliver(*values)
            for engine, *values in zip(alone, request.tolist(), speed.tolist(), strict=True)
        ]
        assert together.deliver(request, speed) == pytest.approx(expected, rel=1e-12, abs=1e-12)
    assert {engine.end_cause for engine in alone} == {'stalled', 'over_revved', None}
