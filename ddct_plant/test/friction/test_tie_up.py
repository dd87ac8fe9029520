# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tie-up work of a period in closed form, on a car whose speeds stay."""

from dataclasses import replace

import numpy as np
import pytest

from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S
from ddct_plant.friction.driveline import FrictionDriveline
from ddct_plant.friction.engagements import OFF_GOING, ON_COMING, both_engaged
from ddct_plant.models.gearbox import Gearbox
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.shift.gear_pair import GearPair

PARAMETERS = DrivelineParameters()
FIRST = Gearbox().gear(1)
TAU_I, TAU_J = FIRST.total_ratio, PARAMETERS.gear.total_ratio
WHEEL_SPEED = 17.3
DIFFERENCE = (TAU_I - TAU_J) * WHEEL_SPEED


def driveline(part: float = 0.5) -> FrictionDriveline:
    """
    Return a driveline with infinite inertias and both gears engaged.

    The engine turns at this part of the way from the on-coming to the off-going shaft.
    """
    heavy = replace(
        PARAMETERS,
        engine_inertia=1e12,
        shaft_inertia=1e12,
        vehicle_inertia=1e12,
        shaft_damping=0.0,
    )
    gears = GearPair(heavy, FIRST)
    on_coming, off_going = TAU_J * WHEEL_SPEED, TAU_I * WHEEL_SPEED
    engine = on_coming + part * (off_going - on_coming)
    sides = InitialSide(on_coming, open=True), InitialSide(off_going)
    start = InitialState(engine, WHEEL_SPEED, 0.0, 0.0, 0.0, sides)
    return FrictionDriveline(both_engaged(gears), VehicleParameters(), start)


def step(car: FrictionDriveline, on_coming: list[float], off_going: list[float]) -> float:
    """Advance by a period with capacities (11,) in N m; return the tie-up work in J."""
    car.step(100.0, 60.0, 0.0, on_coming, on_coming, off_going, off_going)
    work = car.outputs().tie_up_work
    assert work is not None
    return work


def test_the_smaller_torque_counts_where_the_larger_one_changes_within_a_piece():
    """C_2 rises from 0 to 41 N m and is as large as C_1, -20 N m, after 4.9 ms."""
    rising = np.linspace(0.0, 41.0, 11)
    equal_s = PERIOD_S * 20.0 / 41.0
    expected = 20.0 * (equal_s / 2.0 + PERIOD_S - equal_s) * DIFFERENCE
    assert step(driveline(), rising.tolist(), [20.0] * 11) == pytest.approx(expected, rel=1e-9)


def test_a_kink_between_two_nodes_of_the_capacities_counts():
    """C_2 rises to 30 N m in 1 ms and falls again; for a third of both it is below 10 N m."""
    pulse = [0.0] * 4 + [30.0] + [0.0] * 6
    expected = 2.0 * SUBSTEP_S * 10.0 * (1.0 - 1.0 / 6.0) * DIFFERENCE
    assert step(driveline(), pulse, [10.0] * 11) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize('part', [1.5, -0.5])
def test_torques_of_one_sign_do_no_work_against_each_other(part):
    assert step(driveline(part), [50.0] * 11, [20.0] * 11) == 0.0


@pytest.mark.parametrize('open_side', [ON_COMING, OFF_GOING])
def test_an_open_clutch_does_none(open_side):
    capacities = [[50.0] * 11, [50.0] * 11]
    capacities[open_side] = [0.0] * 11
    assert step(driveline(), *capacities) == 0.0
