# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The work of each period warms the clutch of a stick-slip run before its capacity is computed."""

import pytest

from ddct_plant.models.clutch import FrictionClutch, FrictionParameters
from ddct_plant.models.clutch_heat import ClutchHeat, HeatParameters

TORQUES = [100.0] * 11
HOT = HeatParameters(facing_c=245.0, plate_c=245.0)


def clutch(heat=HOT):
    parameters = FrictionParameters(static_over_kinetic=1.5)
    return FrictionClutch(parameters, heat=heat)


def test_no_time_has_passed_at_t0():
    reply = clutch().reply(0, TORQUES, 0.0, 0.0)
    assert reply.temperature_c == 245.0
    assert (reply.kinetic, reply.static) == (TORQUES, [150.0] * 11)


def test_the_work_of_a_period_counts_in_the_next_one():
    model, heat = clutch(), ClutchHeat(HOT)
    model.reply(0, TORQUES, 0.0, 0.0)
    for step in range(1, 20):
        heat.advance(2000.0)
        reply = model.reply(step, TORQUES, 100.0, 2000.0)
        assert reply.temperature_c == heat.facing_c
    assert reply.temperature_c > 255.0
    assert reply.kinetic[0] == pytest.approx(100.0 * (1.0 - 0.2 * (heat.facing_c - 250.0) / 50.0))


def test_skipped_periods_count_with_the_work_of_the_one_after_them():
    missed, complete = clutch(), clutch()
    for step in range(6):
        expected = complete.reply(step, TORQUES, 0.0, 300.0 if step else 0.0)
    missed.reply(0, TORQUES, 0.0, 0.0)
    assert missed.reply(5, TORQUES, 0.0, 300.0) == expected
