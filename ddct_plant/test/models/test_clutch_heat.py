# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The clutch's heat: energy is kept, steps are exact, and holding T over a period is harmless."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.clutch import FrictionClutch, FrictionParameters
from ddct_plant.models.clutch_heat import ClutchHeat, HeatParameters

P = HeatParameters()
CAPACITIES = np.array([P.plate_j_k, P.facing_j_k, P.housing_j_k])


def temperatures_c(heat: Any) -> np.ndarray:
    """Return the temperatures of plate, facing and housing in degrees Celsius."""
    return np.array([heat._ambient_c + above for above in heat._above_ambient])


def test_without_a_way_out_all_work_is_stored_heat():
    heat = ClutchHeat(replace(P, housing_to_ambient_w_k=0.0))
    works = np.random.default_rng(12).uniform(0.0, 400.0, 500)
    for work in works:
        heat.advance(work)
    stored = CAPACITIES @ (temperatures_c(heat) - 20.0)
    assert stored == pytest.approx(works.sum(), rel=1e-11)


def test_work_is_stored_heat_and_what_the_housing_gave_away():
    """The housing warms and cools slowly, so the trapezium rule gives what left it."""
    heat = ClutchHeat(replace(P, facing_c=200.0, plate_c=150.0, housing_c=80.0))
    before, housing = temperatures_c(heat), [temperatures_c(heat)[2]]
    for _ in range(2000):
        heat.advance(50.0)
        housing.append(temperatures_c(heat)[2])
    stored = CAPACITIES @ (temperatures_c(heat) - before)
    given = P.housing_to_ambient_w_k * np.trapezoid(np.array(housing) - P.ambient_c, dx=0.01)
    assert stored + given == pytest.approx(2000 * 50.0, rel=1e-9)


def rates(parameters, temperatures, power):
    """Return the rates in K/s of plate, facing and housing at a friction power in W."""
    p, (plate, facing, housing) = parameters, temperatures
    across = p.facing_to_plate_w_k * (plate - facing)
    down = p.plate_to_housing_w_k * (plate - housing)
    out = p.housing_to_ambient_w_k * (housing - p.ambient_c)
    flows = [
        (1.0 - p.facing_share) * power - across - down,
        p.facing_share * power + across,
        down - out,
    ]
    return np.array(flows) / CAPACITIES


def test_a_period_is_that_of_the_differential_equations():
    start = replace(P, facing_c=240.0, plate_c=90.0, housing_c=40.0, ambient_c=-10.0)
    heat, power = ClutchHeat(start), 30_000.0
    for _ in range(100):
        heat.advance(power * 0.01)
    solution = scipy.integrate.solve_ivp(
        lambda _, t: rates(start, t, power), (0.0, 1.0), (90.0, 240.0, 40.0), rtol=1e-11, atol=1e-9
    )
    assert temperatures_c(heat) == pytest.approx(solution.y[:, -1], rel=1e-8)


def test_a_clutch_at_ambient_temperature_stays_there_to_the_last_bit():
    heat = ClutchHeat(P)
    for _ in range(100):
        heat.advance(0.0)
    assert temperatures_c(heat).tolist() == [20.0, 20.0, 20.0]


def test_a_hard_launch_of_40_kj_warms_the_facing_by_30_to_40_k():
    heat = ClutchHeat(P)
    for _ in range(200):
        heat.advance(200.0)
    for _ in range(300):
        heat.advance(0.0)
    assert 30.0 < heat.facing_c - 20.0 < 40.0


ENGINE, VEHICLE = 0.25, 0.01 + 154.7 / 16.06**2
"""J_m and J_p + J_v/tau^2 in first gear, kg m^2."""
ENGINE_TORQUE = 252.0
FADING = FrictionParameters(slip_rad_s=(0.0, 300.0), slip_share=(1.0, 0.85))


HOT = replace(P, facing_c=240.0, plate_c=240.0, housing_c=80.0)


def launched(*, held: bool) -> tuple[float, float, float]:
    """
    Return lock-up time in s, friction work in J and facing temperature at the end of a launch.

    240 degrees at first, 252 N m of engine and 250 N m of cold capacity at 290 rad/s of slip,
    in sub-steps of 0.1 ms. Held, friction has the temperature and slip of the period's start and
    `ClutchHeat` takes its work; else friction and the masses move with every sub-step.
    """
    clutch, heat = FrictionClutch(FADING), ClutchHeat(HOT)
    fine = np.array([HOT.plate_c, HOT.facing_c, HOT.housing_c])
    slip, total, in_period, torque, step = 290.0, 0.0, 0.0, 0.0, 0
    while slip > 0.0:
        if held and step % 100 == 0:
            heat.advance(in_period)
            in_period = 0.0
        if not held or step % 100 == 0:
            facing = heat.facing_c if held else fine[1]
            torque = clutch.capacity([250.0], facing, slip).kinetic[0]
        rate = ENGINE_TORQUE / ENGINE - torque * (1.0 / ENGINE + 1.0 / VEHICLE)
        power = torque * (slip + 0.5e-4 * rate)
        fine += 1e-4 * rates(HOT, fine, power)
        total, in_period = total + 1e-4 * power, in_period + 1e-4 * power
        slip, step = slip + 1e-4 * rate, step + 1
    return step * 1e-4, total, heat.facing_c if held else fine[1]


def test_holding_temperature_and_slip_over_10_ms_costs_a_hard_launch_a_quarter_percent():
    held, resolved = launched(held=True), launched(held=False)
    assert resolved[1] == pytest.approx(40e3, rel=0.1), 'a hard launch'
    assert resolved[2] > 255.0, 'that fades'
    time, work, facing = held
    assert time / resolved[0] - 1.0 == pytest.approx(0.0028, abs=5e-4), 'lock-up 3 ms later'
    assert work / resolved[1] - 1.0 == pytest.approx(0.0024, abs=5e-4), '0.24 % of the work'
    assert facing == pytest.approx(resolved[2], abs=0.1), 'less than 0.1 K'


@pytest.mark.parametrize(
    ('bad', 'key'),
    [
        ({'facing_j_k': 0.0}, 'heat.facing_j_k'),
        ({'plate_to_housing_w_k': -1.0}, 'heat.plate_to_housing_w_k'),
        ({'facing_share': 1.5}, 'heat.facing_share'),
        ({'facing_c': float('inf')}, 'heat.facing_c'),
    ],
)
def test_a_bad_mass_path_or_temperature_is_named(bad, key):
    with refused(ParameterError, key=key):
        HeatParameters(**bad)
