# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The capacity of a friction clutch: wear, heat, slip speed, kiss point and static friction."""

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.clutch import FrictionClutch, FrictionParameters, LinearClutch

RISING = [-20.0, -1e-9, 0.0, 1.0, 10.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0]
"""(11,) N m, from an undershoot of the actuator up."""


@pytest.mark.parametrize('wear_gain', [0.7, 1.0, 1.3])
@pytest.mark.parametrize('ratio', [1.0, 1.2])
def test_a_new_cold_facing_carries_what_the_linear_clutch_transmits(wear_gain, ratio):
    clutch = FrictionClutch(FrictionParameters(static_over_kinetic=ratio), wear_gain)
    found = clutch.capacity(RISING, 20.0, 35.0)
    linear = LinearClutch(wear_gain).transmit(RISING)
    assert found.kinetic == [min(max(torque, 0.0), 350.0) for torque in linear], 'to the last bit'
    assert found.static == [ratio * torque for torque in found.kinetic]


def test_heat_takes_friction_away_from_250_degrees_on():
    clutch = FrictionClutch(FrictionParameters())
    found = [clutch.capacity([100.0] * 11, degrees).kinetic[0] for degrees in (-40, 250, 275)]
    assert found == pytest.approx([100.0, 100.0, 90.0])
    assert clutch.capacity([100.0], 1000.0).kinetic == pytest.approx([40.0]), 'the end is held'


def test_friction_over_slip_speed_is_even_and_off_unless_it_is_given():
    assert FrictionClutch(FrictionParameters()).capacity([100.0], 20.0, 300.0).kinetic == [100.0]
    falling = FrictionParameters(1.1, slip_rad_s=(0.0, 100.0), slip_share=(1.0, 0.8))
    ways = [FrictionClutch(falling).capacity([100.0], 20.0, slip) for slip in (50.0, -50.0)]
    assert ways[0] == ways[1]
    assert ways[0].kinetic == pytest.approx([90.0])
    assert ways[0].static == pytest.approx([99.0])


@pytest.mark.parametrize('share', [(1.0, 0.5), (0.5, 1.0)])
@pytest.mark.parametrize('slip', [0.0, 40.0, 200.0])
def test_static_capacity_is_never_below_the_kinetic_one(share, slip):
    parameters = FrictionParameters(slip_rad_s=(0.0, 100.0), slip_share=share)
    found = FrictionClutch(parameters, 0.7).capacity(RISING, 280.0, slip)
    assert all(s >= k >= 0.0 for s, k in zip(found.static, found.kinetic, strict=True))


def test_below_the_kiss_point_nothing_is_carried_and_above_it_the_rest():
    clutch = FrictionClutch(FrictionParameters(kiss_torque_n_m=12.0), 0.5)
    assert clutch.capacity([0.0, 11.9, 12.0, 20.0]).kinetic == [0.0, 0.0, 0.0, 4.0]


def test_a_hot_clutch_carries_more_at_one_actuator_torque_but_opens_at_a_request_of_zero():
    clutch = FrictionClutch(FrictionParameters(kiss_torque_n_m=12.0, kiss_drift_n_m_k=0.1))
    found = clutch.capacity([-1.0, 0.0, 50.0], temperature_c=220.0)
    assert found.kinetic == pytest.approx([0.0, 0.0, 50.0 - 12.0 + 0.1 * 200.0])


def test_a_hot_clutch_that_opens_in_a_run_drops_the_rest_of_the_actuator_torque():
    """At 220 °C it would carry 20 N m at any torque above zero, however small."""
    parameters = FrictionParameters(kiss_drift_n_m_k=0.1)
    decaying = [1.0, 0.02, 0.01, 1e-9]
    clutch = FrictionClutch(parameters, open_below=0.01)
    found = clutch.capacity(decaying, temperature_c=220.0).kinetic
    assert found == pytest.approx([21.0, 20.02, 0.0, 0.0])
    found = FrictionClutch(parameters).capacity(decaying, temperature_c=220.0).kinetic
    assert found == pytest.approx([21.0, 20.02, 20.01, 20.0])


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_no_request_makes_it_carry_more_than_its_greatest_capacity(wear_gain):
    """Whatever the wear; the static capacity is in proportion."""
    clutch = FrictionClutch(FrictionParameters(1.1, most_n_m=200.0), wear_gain)
    found = clutch.capacity([0.0, 100.0, 300.0, 2e14])
    assert found.kinetic == [0.0, wear_gain * 100.0, 200.0, 200.0]
    assert found.static == [1.1 * torque for torque in found.kinetic]


@pytest.mark.parametrize(
    ('bad', 'key'),
    [
        ({'static_over_kinetic': 0.9}, 'friction.static_over_kinetic'),
        ({'temperature_share': (1.0, -0.1, 0.4)}, 'friction.temperature_share[1]'),
        ({'temperature_c': (300.0, 250.0, 400.0)}, 'friction.temperature_c'),
        ({'temperature_share': (1.0,)}, 'friction.temperature_share'),
        ({'slip_rad_s': (0.0, 0.0), 'slip_share': (1.0, 1.0)}, 'friction.slip_rad_s'),
        ({'slip_share': (1.0,)}, 'friction.slip_share'),
        ({'most_n_m': 0.0}, 'friction.most_n_m'),
        ({'kiss_torque_n_m': -1.0}, 'friction.kiss_torque_n_m'),
        ({'kiss_drift_n_m_k': float('nan')}, 'friction.kiss_drift_n_m_k'),
    ],
)
def test_bad_friction_is_named(bad, key):
    with refused(ParameterError, key=key):
        FrictionParameters(**bad)
