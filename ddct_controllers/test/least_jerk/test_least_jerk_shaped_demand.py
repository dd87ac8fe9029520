# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The engine torque of `least_jerk` follows a demand without exciting the locked driveline."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ddct_controllers.design.analysis.driveline_mode import locked_driveline_zero
from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.least_jerk.controller import SPEC
from ddct_controllers.least_jerk.shaped_demand import (
    WAIT_STEPS,
    ShapedDemand,
    shaping_steps,
)
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

STEPS = 34
"""Period of the locked driveline in second gear, in steps."""


def demands(*values: float) -> list[Measurement]:
    """Return measurements with these demands in N m."""
    return [
        Measurement(step, 160.0, 160.0, 17.0, 5.6, v, [0.0], [0.0])
        for step, v in enumerate(values)
    ]


def shaped(engine: ShapedDemand, *values: float, closed: bool = True) -> list[float]:
    """Return C_m in N m for demands in N m."""
    return [engine.update(m, closed=closed)[0].engine_torque for m in demands(*values)]


def after(demand: float, authority: EngineAuthority | None = None) -> ShapedDemand:
    """Return the shaped demand after a steady one in N m."""
    engine = ShapedDemand(STEPS, authority or EngineAuthority())
    engine.hold(demand)
    return engine


@pytest.mark.parametrize('ratio', [5.0, 9.3416024, 16.06])
def test_the_steps_are_a_period_of_the_locked_driveline(ratio):
    driveline = replace(DrivelineParameters(), gear=EngagedGear(ratio))
    zero = locked_driveline_zero(driveline)
    assert zero is not None
    period_s = math.tau / zero.imag
    assert shaping_steps(driveline, 1.0) * PERIOD_S == pytest.approx(period_s, abs=0.006)
    assert shaping_steps(driveline, 0.0) == 0


def test_a_driveline_that_does_not_oscillate_needs_no_steps():
    assert shaping_steps(replace(DrivelineParameters(), halfshaft_damping=1e4), 1.0) == 0


def test_a_step_of_the_demand_becomes_a_ramp_of_a_period():
    torques = shaped(after(60.0), *[320.0] * (STEPS + 5))
    np.testing.assert_allclose(np.diff(torques[:STEPS]), 260.0 / STEPS)
    np.testing.assert_allclose(torques[STEPS - 1 :], 320.0)


def test_the_ramp_leaves_no_oscillation():
    """The twist of the undamped driveline after a step, with the ramp and without."""
    torques = np.array(shaped(after(0.0), *[1.0] * (3 * STEPS)))
    rate = math.tau / STEPS
    phases = np.exp(1j * rate * np.arange(len(torques)))
    assert abs(np.diff(torques, prepend=0.0) @ phases) < 1e-12
    assert abs(np.diff(np.ones_like(torques), prepend=0.0) @ phases) == pytest.approx(1.0)


def test_a_change_waits_until_the_plates_are_closed():
    engine = after(60.0)
    assert shaped(engine, *[320.0] * 20, closed=False) == [60.0] * 20
    np.testing.assert_allclose(shaped(engine, *[320.0] * STEPS)[-1], 320.0)


def test_a_driver_gets_the_demand_from_plates_that_never_close():
    torques = shaped(after(60.0), *[320.0] * (WAIT_STEPS + STEPS), closed=False)
    assert torques[WAIT_STEPS - 1] == 60.0
    assert torques[-1] == pytest.approx(320.0)


def test_the_authority_over_the_engine_bounds_the_torque():
    engine = after(60.0, EngineAuthority(deviation_n_m=100.0))
    assert min(shaped(engine, *[320.0] * STEPS)) == 220.0


@pytest.mark.parametrize(
    ('scenario', 'periods', 'commands'),
    [
        ('tip_in', 1.0, True),
        ('tip_in', 0.0, False),
        ('launch', 1.0, False),
        ('upshift', 1.0, False),
    ],
)
def test_only_a_run_that_starts_locked_has_its_engine_commanded(scenario, periods, commands):
    settings = RunSettings(KnownSettings(load_scenario(scenario)))
    controller = SPEC(ControllerContext(settings.known, {'demand_periods': periods}))
    assert controller.commands_engine is commands
