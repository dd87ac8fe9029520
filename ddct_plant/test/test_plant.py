# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plant without ROS: delivered and resisting torques at each step."""

import pytest

from ddct_plant.base.timebase import time_of_step
from ddct_plant.plant import Plant
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.plant import make_engine, make_load
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SLOPE = 'slope={time_s: [0.0, 1.0], slope_rad: [0.0, 0.2]}'


@pytest.mark.parametrize('name', ['thesis', 'thesis_sticking'])
def test_the_load_is_that_of_the_slope_at_the_time_of_each_step(name):
    settings = RunSettings(KnownSettings(load_scenario(name, [SLOPE])))
    plant, load = Plant(settings), make_load(settings)
    found = []
    for step in range(60):
        tick = plant.tick(step)
        reply = plant.reply(plant.observe(tick), 0.0)
        assert reply.load_torque == load.torque(tick.true.vehicle_speed, time_of_step(step))
        found.append(reply.load_torque)
        plant.advance(reply)
    assert found[-1] > found[0] + 400.0, 'at 0.118 rad'


def test_a_commanded_engine_delivers_what_its_limits_allow_at_the_speed_of_the_engine():
    """At rest in gear: the shaft has no speed, at which the engine would deliver nothing."""
    settings = RunSettings(KnownSettings(load_scenario('launch')))
    plant, engine = Plant(settings, two_input=True), make_engine(settings)
    observation = plant.observe(plant.tick(0))
    engine_speed, shaft_speed = observation.tick.true.joint_speed[:2]
    assert engine_speed == pytest.approx(104.72)
    assert shaft_speed == 0.0
    found = plant.reply(observation, 0.0, 80.0).engine_torque
    assert found == engine.torque(engine.demand(0), 80.0, engine_speed)
    assert found != make_engine(settings).torque(engine.demand(0), 80.0, shaft_speed)
