# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The constant-M and constant-S curves, and whether loops enter them."""

import math

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.drawing.nichols import (
    NicholsCurve,
    constant_m_curve,
    constant_n_curve,
    constant_s_curve,
    nichols_curve,
)
from ddct_controllers.design.loop_shaping.design import NETWORK_SPECIFICATIONS
from ddct_controllers.design.loop_shaping.verification import contours
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import ParameterError


def loop_values(curve: NicholsCurve) -> np.ndarray:
    return 10.0 ** (curve.magnitude_db / 20.0) * np.exp(1j * np.radians(curve.phase_deg))


@pytest.mark.parametrize('level', [0.5, 1.0, 1.112, 1.43, 3.0])
def test_every_point_of_the_curves_has_their_level(level):
    on_m, on_s = loop_values(constant_m_curve(level)), loop_values(constant_s_curve(level))
    assert np.abs(on_m / (1.0 + on_m)) == pytest.approx(level, rel=1e-9)
    assert 1.0 / np.abs(1.0 + on_s) == pytest.approx(level, rel=1e-9)


@pytest.mark.parametrize('phase_deg', [-30.0, -90.0, -150.0, -210.0, -330.0])
def test_every_point_of_a_curve_of_constant_phase_has_it(phase_deg):
    loop = loop_values(constant_n_curve(phase_deg))
    off = np.angle(loop / (1.0 + loop) * np.exp(-1j * math.radians(phase_deg)))
    assert np.abs(off).max() < 1e-6


def test_curves_above_1_close_around_the_critical_point():
    for curve in (constant_m_curve(1.112), constant_s_curve(1.43)):
        assert -360.0 < curve.phase_deg.min() < -180.0 < curve.phase_deg.max() < 0.0
        assert np.abs(np.diff(curve.phase_deg)).max() < 10.0
        assert curve.magnitude_db.min() < 0.0 < curve.magnitude_db.max()


def test_the_phase_of_a_double_integrator_starts_at_minus_180_degrees():
    curve = LoopCurve(continuous_loop(PRINTED_CONTROLLERS['ls7']))
    phase = nichols_curve(curve.values).phase_deg
    assert phase[0] == pytest.approx(-180.0, abs=0.1)
    assert np.abs(np.diff(phase)).max() < 90.0


def crosses(name: str) -> tuple[bool, bool]:
    """Return whether a loop enters the S_p and the T_p curve of 14 % overshoot."""
    found = contours(LoopCurve(continuous_loop(PRINTED_CONTROLLERS[name])), NETWORK_SPECIFICATIONS)
    return (not found[0].respected, not found[1].respected)


@pytest.mark.parametrize(
    ('name', 'expected'),
    [
        ('ls2', (False, True)),
        ('ls3', (True, True)),
        ('ls7', (False, True)),
        ('ls9', (False, False)),
    ],
)
def test_g_c1_and_g_c2_cross_the_t_p_circle_and_the_fastest_g_c2_does_not(name, expected):
    """The thesis states it for G_c1; so does G_c2, with M_t 1.150 above 1.112."""
    assert crosses(name) == expected


def test_a_contour_has_the_frequencies_at_which_the_loop_is_inside():
    curve = LoopCurve(continuous_loop(PRINTED_CONTROLLERS['ls2']))
    _, found = contours(curve, NETWORK_SPECIFICATIONS)
    ((first, last),) = found.inside_rad_s
    assert first < found.peak_rad_s < last
    for edge in (first, last):
        value = curve.at(edge)
        assert abs(value / (1.0 + value)) == pytest.approx(found.level, rel=1e-9)
    assert found.peak == pytest.approx(1.185, abs=5e-4)


@pytest.mark.parametrize('level', [0.0, -1.0, math.nan])
def test_a_level_that_no_loop_has_is_refused(level):
    with refused(ParameterError, 'level of |T|'):
        constant_m_curve(level)
