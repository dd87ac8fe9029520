# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The 4-state driveline: physics of its matrices, its transfer functions, its modes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import Factor
from ddct_plant.models.driveline_model import (
    clutch_to_slip,
    driveline_matrices,
    engine_to_slip,
    load_to_slip,
)
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.models.printed import ACTUATOR, ENGINE_TO_SLIP, LOAD_TO_SLIP, PrintedNumber

DEFAULT = DrivelineParameters()
VARIANTS = {
    'default': DEFAULT,
    'damped engine': replace(DEFAULT, engine_damping=0.02),
    'undamped shaft': replace(DEFAULT, shaft_damping=0.0),
    'overdamped half-shaft': replace(DEFAULT, halfshaft_damping=2000.0),
}


@pytest.mark.parametrize('name', VARIANTS)
def test_transfer_functions_are_those_of_the_matrices(name):
    parameters = VARIANTS[name]
    model = driveline_matrices(parameters)
    omega = np.logspace(-3, 4, 40)
    functions = engine_to_slip(parameters), clutch_to_slip(parameters), load_to_slip(parameters)
    for column, function in enumerate(functions):
        expected = [
            (model.c @ np.linalg.solve(1j * w * np.eye(4) - model.a, model.b))[0, column]
            for w in omega
        ]
        np.testing.assert_allclose(function.frequency_response(omega), expected, rtol=1e-8)


def test_halfshaft_pushes_the_vehicle_as_hard_as_it_holds_the_shaft():
    """Only c_sa/(J_v tau) does this, not the c_sa/(J_p tau) of the third printed equation."""
    model = driveline_matrices(DEFAULT)
    ratio, shaft, vehicle = (
        DEFAULT.gear.total_ratio,
        DEFAULT.shaft_inertia,
        DEFAULT.vehicle_inertia,
    )
    momentum_rate = ratio * shaft * model.a[1] + vehicle * model.a[2]
    drag = np.array([0.0, -ratio * DEFAULT.shaft_damping, 0.0, 0.0])
    np.testing.assert_allclose(momentum_rate, drag, atol=1e-9)
    misprinted = model.a.copy()
    misprinted[2, 1] = DEFAULT.halfshaft_damping / (shaft * ratio)
    assert np.linalg.eigvals(misprinted).real.max() > 100.0


def test_p2_gain_and_p3_zero_have_their_closed_forms():
    p2, p3 = clutch_to_slip(DEFAULT), load_to_slip(DEFAULT)
    assert p2.gain == -(1 / DEFAULT.engine_inertia + 1 / DEFAULT.shaft_inertia)
    assert p3.numerator == (DEFAULT.halfshaft_stiffness / DEFAULT.halfshaft_damping,)


def mode(pair: Factor) -> tuple[float, float]:
    """Return the natural frequency in Hz and the damping ratio of s^2 + b s + c."""
    assert isinstance(pair, tuple)
    frequency = math.sqrt(pair[1])
    return frequency / (2 * math.pi), pair[0] / (2 * frequency)


def test_slipping_driveline_has_one_mode_at_14_hz_and_a_locked_one_at_3_hz():
    p2 = clutch_to_slip(DEFAULT)
    assert mode(p2.denominator[-1]) == pytest.approx((13.96, 0.692), rel=1e-3)
    assert mode(p2.numerator[-1]) == pytest.approx((2.932, 0.1450), rel=1e-3)


def test_zeros_of_p2_are_the_poles_of_the_locked_driveline():
    locked = replace(DEFAULT, shaft_inertia=DEFAULT.shaft_inertia + DEFAULT.engine_inertia)
    poles = clutch_to_slip(locked).denominator[1:]
    for found, expected in zip(clutch_to_slip(DEFAULT).numerator, poles, strict=True):
        assert found == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize(
    ('change', 'key'),
    [
        ({'engine_inertia': 0.0}, 'driveline.engine_inertia'),
        ({'shaft_damping': -0.1}, 'driveline.shaft_damping'),
        ({'total_ratio': float('nan')}, 'total_ratio'),
        ({'vehicle_inertia': '150'}, 'driveline.vehicle_inertia'),
    ],
)
def test_impossible_driveline_is_refused_by_name(change, key):
    with refused(ParameterError, key=key):
        DrivelineParameters.from_values(change)


def test_vehicle_and_driveline_agree_on_the_vehicle_inertia():
    vehicle = VehicleParameters()
    inertia = vehicle.mass_kg * vehicle.wheel_radius_m**2
    assert inertia == pytest.approx(DEFAULT.vehicle_inertia, rel=1e-14)
    with refused(ParameterError, key='vehicle.mass_kg'):
        VehicleParameters(mass_kg=-1.0)


def test_actuator_has_unit_gain_33_ms_of_lag_and_zeros_in_the_right_half_plane():
    gain = abs(ACTUATOR.frequency_response(np.array(0.0)))
    assert gain == pytest.approx(1.0, abs=5e-5)
    small = 1e-3
    lag = -np.angle(ACTUATOR.frequency_response(np.array(small))) / small
    assert lag == pytest.approx(0.0331, abs=5e-5)
    right = ACTUATOR.zeros[ACTUATOR.zeros.real > 0]
    np.testing.assert_allclose(sorted(right.imag), [-157.6, 157.6], atol=0.05)
    np.testing.assert_allclose(right.real, 80.65, atol=1e-9)


@pytest.mark.parametrize(
    ('text', 'half_unit'),
    [('7696', 0.5), ('0.005905', 5e-7), ('3.134e04', 5.0), ('-103.43', 0.005), ('4', 0.5)],
)
def test_half_unit_of_a_printed_number(text, half_unit):
    number = PrintedNumber('', text)
    assert number.half_unit == half_unit
    assert number.value == float(text)


def test_printed_numbers_are_named_in_the_order_of_printing():
    assert [(n.label, n.text) for n in LOAD_TO_SLIP.numbers()] == [
        ('gain', '7.2217'),
        ('zero a', '63.99'),
        ('pole a', '0.006733'),
        ('pole b', '121.4'),
        ('pole c', '7696'),
    ]
    assert [n.label for n in ENGINE_TO_SLIP.numbers()] == ['gain']
