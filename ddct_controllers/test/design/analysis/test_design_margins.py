# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Margins are exact: against closed forms, python-control, and the closed loop's poles."""

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import ContinuousLoop, continuous_loop, sampled_loop
from ddct_controllers.design.analysis.margins import (
    LoopMargins,
    closed_loop_stable,
    loop_margins,
    unstable_poles,
)
from ddct_controllers.design.state_space import frequency_response, scaled, series
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh

if TYPE_CHECKING:
    import control

pytestmark = pytest.mark.slow

NAMES = sorted(PRINTED_CONTROLLERS)


def sampled(name: str, wear_gain: float = 1.0) -> StateSpace:
    controller = PRINTED_CONTROLLERS[name].to_state_space()
    return sampled_loop(discretise_zoh(controller, PERIOD_S), wear_gain=wear_gain)


def of_control(loop: StateSpace) -> 'control.StateSpace':
    import control

    return control.ss(loop.a, loop.b, loop.c, loop.d, loop.period_s or 0)


def delayed(loop: StateSpace, samples: int) -> StateSpace:
    one, zero = np.ones((1, 1)), np.zeros((1, 1))
    return series(loop, *[StateSpace(zero, one, one, zero, PERIOD_S)] * samples)


def test_margins_of_a_third_order_loop_in_closed_form():
    """L = 0.5/(s (s+1)^2): |L| = 1/2 at -180 deg, w = 1; |L| = 1 where w^3 + w = 0.5."""
    margins = loop_margins(ContinuousLoop(FactoredTransferFunction(0.5, (), (0.0, 1.0, 1.0))))
    crossover = float(np.roots([1.0, 0.0, 1.0, -0.5])[-1].real)
    phase = math.pi / 2.0 - 2.0 * math.atan(crossover)
    assert margins.stable
    assert margins.gain_margin_db == pytest.approx(20.0 * math.log10(4.0), abs=1e-9)
    assert margins.gain_reduction_margin_db == math.inf
    assert margins.crossover_rad_s == pytest.approx(crossover, rel=1e-9)
    assert margins.phase_margin_deg == pytest.approx(math.degrees(phase), abs=1e-8)
    assert margins.delay_margin_s == pytest.approx(phase / crossover, rel=1e-9)


def test_peaks_and_bandwidth_of_a_second_order_loop_in_closed_form():
    """T = 1/(s^2 + 2 zeta s + 1): M_t = 1/(2 zeta sqrt(1 - zeta^2)), S = s (s + 2 zeta) T."""
    zeta = 0.3
    margins = loop_margins(ContinuousLoop(FactoredTransferFunction(1.0, (), (0.0, 2.0 * zeta))))
    damped = 1.0 - 2.0 * zeta**2
    omega = np.linspace(0.5, 3.0, 1_000_001)
    distance = np.abs(-(omega**2) + 2.0j * zeta * omega)
    sensitivity = distance / np.abs(1.0 - omega**2 + 2.0j * zeta * omega)
    assert margins.complementary_peak == pytest.approx(
        1.0 / (2.0 * zeta * math.sqrt(1.0 - zeta**2)), rel=1e-9
    )
    assert margins.sensitivity_peak == pytest.approx(sensitivity.max(), rel=1e-9)
    assert margins.bandwidth_rad_s == pytest.approx(
        math.sqrt(damped + math.sqrt(damped**2 + 1.0)), rel=1e-9
    )
    assert margins.gain_margin_db == math.inf


@pytest.mark.parametrize(
    'name', ['ls8', *(pytest.param(name, marks=pytest.mark.nightly) for name in ('hinf2', 'ls3'))]
)
def test_they_are_those_of_python_control(name):
    """python-control interpolates between 3000 points; its disk margin is the least of theirs."""
    import control

    for loop in (continuous_loop(PRINTED_CONTROLLERS[name]).to_state_space(), sampled(name)):
        found = loop_margins(loop)
        last = math.pi / loop.period_s if loop.period_s else 1e3
        omega = np.geomspace(1e-2, last, 3000)
        values = frequency_response(loop, omega)
        frd = control.frd(values, omega, smooth=True)
        gain, phase, _, _, crossover, _ = control.stability_margins(frd)
        assert found.gain_margin_db == pytest.approx(20.0 * math.log10(gain), abs=1e-3)
        assert found.phase_margin_deg == pytest.approx(phase, abs=1e-3)
        assert found.crossover_rad_s == pytest.approx(crossover, rel=1e-4)
        disk = control.disk_margins(of_control(loop), omega, skew=0.0)[0]
        assert found.disk_margin == pytest.approx(disk, rel=1e-3)
        assert found.disk_margin <= disk * (1.0 + 1e-9)
        assert found.sensitivity_peak == pytest.approx(
            np.max(1.0 / np.abs(1.0 + values)), rel=1e-3
        )
        assert found.complementary_peak == pytest.approx(
            np.max(np.abs(values / (1.0 + values))), rel=1e-3
        )


def crossings_by_polynomials(loop: FactoredTransferFunction) -> tuple[np.ndarray, np.ndarray]:
    """Return where N(s) N(-s) = D(s) D(-s) on the axis, rising, and the angle of -L there."""

    def even(roots: np.ndarray) -> np.ndarray:
        return np.polymul(np.poly(roots), (-1.0) ** len(roots) * np.poly(-roots)).real

    roots = np.roots(np.polysub(loop.gain**2 * even(loop.zeros), even(loop.poles)))
    omega = np.sort(roots[(np.abs(roots.real) < 1e-6) & (roots.imag > 0.0)].imag)
    return omega, np.angle(-loop.frequency_response(omega))


THIRD_OF_FIVE = FactoredTransferFunction(
    18.8, ((0.2, 49.0), (0.2, 961.0)), (0.0, (1.0, 625.0), (1.0, 961.0))
)
LEADING_SECOND = FactoredTransferFunction(
    6.9, (17.3, (0.2, 0.16), 0.6), ((1.0, 0.09), (0.5, 37.21), (0.5, 1.21), 0.0)
)


def test_phase_and_delay_margin_are_the_least_of_all_crossovers():
    """Here those of the third of five crossovers are the least."""
    omega, angles = crossings_by_polynomials(THIRD_OF_FIVE)
    delays = np.mod(angles, math.tau) / omega
    assert len(omega) == 5
    assert np.argmin(np.abs(angles)) == np.argmin(delays) == 2
    margins = loop_margins(ContinuousLoop(THIRD_OF_FIVE))
    assert margins.phase_margin_deg == pytest.approx(math.degrees(abs(angles[2])), rel=1e-6)
    assert margins.delay_margin_s == pytest.approx(delays[2], rel=1e-6)
    assert margins.crossover_rad_s == pytest.approx(omega[-1], rel=1e-6)


def test_a_lead_takes_nearly_a_turn_of_delay():
    """The second of three crossovers has 28 degrees of lead, the first 28 of lag."""
    omega, angles = crossings_by_polynomials(LEADING_SECOND)
    assert np.abs(angles / omega).argmin() == 1
    margins = loop_margins(ContinuousLoop(LEADING_SECOND))
    assert margins.delay_margin_s == pytest.approx(angles[0] / omega[0], rel=1e-6)


@pytest.mark.parametrize(
    ('factored', 'least_increase'),
    [
        (
            FactoredTransferFunction(
                2.3,
                ((-0.2, 0.64), (1.0, 60.84), (0.2, 79.21)),
                ((1.0, 299.29), (0.5, 4.84), (1.0, 42.25), 0.0),
            ),
            True,
        ),
        (FactoredTransferFunction(56.1, ((1.0, 6.25),), ((0.5, 4.0), -1.0)), False),
    ],
)
def test_of_several_critical_gains_the_nearest_is_the_margin(factored, least_increase):
    """The loop is stable at every gain on the way to it, by its poles, and unstable beyond."""
    margins = loop_margins(ContinuousLoop(factored))
    if least_increase:
        critical = 10.0 ** (margins.gain_margin_db / 20.0)
    else:
        critical = 10.0 ** (-margins.gain_reduction_margin_db / 20.0)
    factors = np.geomspace(1.0, critical, 300)
    factors[-1] *= 1.0 - math.copysign(1e-4, critical - 1.0)
    stable = [by_poles(factored, factor) for factor in factors]
    assert all(stable)
    assert not by_poles(factored, critical * (1.0 + math.copysign(1e-4, critical - 1.0)))


def by_poles(factored: FactoredTransferFunction, gain: float) -> bool:
    """Return whether D + gain N has all its roots on the left."""
    numerator = gain * factored.gain * np.poly(factored.zeros).real
    roots = np.roots(np.polyadd(np.poly(factored.poles).real, numerator))
    return bool(np.all(roots.real < 0.0))


def test_a_sampled_loop_is_evaluated_up_to_half_the_sampling_rate():
    """L = 0.4/(z - 0.5): closed-loop pole 0.5 - 0.4 k, at -1 for k = 3.75; M_s = 1/(1 + L(-1))."""
    one = np.ones((1, 1))
    margins = loop_margins(StateSpace(0.5 * one, one, 0.4 * one, 0.0 * one, PERIOD_S))
    assert margins.gain_margin_db == pytest.approx(20.0 * math.log10(3.75), abs=1e-9)
    assert margins.sensitivity_peak == pytest.approx(1.0 / (1.0 - 0.4 / 1.5), rel=1e-12)


@pytest.mark.parametrize(
    ('a', 'c', 'period_s'),
    [
        ([[1.0]], [[0.0]], PERIOD_S),
        ([[1.0]], [[2.0]], PERIOD_S),
        ([[0.0, 1.0], [0.0, 0.0]], [[1.0, 0.0]], PERIOD_S),
        ([[0.0]], [[0.0]], None),
        ([[0.0, 1.0], [0.0, 0.0]], [[1.0, 0.0]], None),
    ],
    ids=['z = 1', 'z = -1', 'z = +-j', 's = 0', 's = +-j'],
)
def test_a_closed_loop_pole_on_the_boundary_is_not_stable(a, c, period_s):
    b = np.eye(len(a))[:, -1:]
    loop = StateSpace(np.array(a), b, np.array(c), np.zeros((1, 1)), period_s)
    assert unstable_poles(loop) == len(a)
    assert not closed_loop_stable(loop)
    assert not loop_margins(loop).stable


@pytest.mark.parametrize('name', NAMES)
def test_the_gain_margins_are_where_poles_reach_the_unit_circle(name):
    """It is stable 0.1 % inside both and unstable 0.1 % outside, by the closed loop's poles."""
    loop = sampled(name)
    margins = loop_margins(loop)
    raising = 10.0 ** (margins.gain_margin_db / 20.0)
    lowering = 10.0 ** (-margins.gain_reduction_margin_db / 20.0)
    assert closed_loop_stable(scaled(loop, raising * 0.999))
    assert not closed_loop_stable(scaled(loop, raising * 1.001))
    if lowering > 0.0:
        assert closed_loop_stable(scaled(loop, lowering * 1.001))
        assert not closed_loop_stable(scaled(loop, lowering * 0.999))


@pytest.mark.parametrize('name', NAMES)
def test_the_delay_margin_is_the_number_of_stable_samples_of_delay(name):
    loop = sampled(name)
    samples = math.floor(loop_margins(loop).delay_margin_s / PERIOD_S)
    assert closed_loop_stable(delayed(loop, samples))
    assert not closed_loop_stable(delayed(loop, samples + 1))


@pytest.mark.parametrize(
    ('name', 'crossover', 'phase', 'gain', 'complementary'),
    [('ls2', 7.08, 55.0, 12.97, 1.185), ('ls7', 3.79, 73.7, 27.04, 1.150)],
)
def test_g_c1_and_g_c2_exceed_their_t_p_without_hold_and_delay(
    name, crossover, phase, gain, complementary
):
    """Equations (2.1), (2.2): M_t of both is above the T_p = 1.11 of Section 2.2."""
    margins = loop_margins(continuous_loop(PRINTED_CONTROLLERS[name]))
    assert margins.crossover_rad_s == pytest.approx(crossover, abs=0.01)
    assert margins.phase_margin_deg == pytest.approx(phase, abs=0.05)
    assert margins.gain_margin_db == pytest.approx(gain, abs=0.01)
    assert margins.complementary_peak == pytest.approx(complementary, abs=0.001)


def test_hinf2_has_little_margin_in_the_loop_as_it_runs():
    """M_s is 1.45 on paper, 3.35 with hold and delay, 9.66 at a wear gain of 1.3."""
    paper = loop_margins(continuous_loop(PRINTED_CONTROLLERS['hinf2']))
    assert paper.sensitivity_peak == pytest.approx(1.454, abs=0.001)
    assert loop_margins(sampled('hinf2')).sensitivity_peak == pytest.approx(3.354, abs=0.001)
    assert loop_margins(sampled('hinf2', 1.3)).sensitivity_peak == pytest.approx(9.656, abs=0.005)


def test_an_unstable_loop_has_no_margins():
    loop = sampled('hinf2', 1.6)
    assert loop_margins(loop) == LoopMargins(stable=False)
    assert vars(LoopMargins(stable=False)) == {
        'stable': False,
        **dict.fromkeys(
            ('gain_margin_db', 'gain_reduction_margin_db', 'phase_margin_deg', 'delay_margin_s')
            + ('disk_margin', 'sensitivity_peak', 'complementary_peak', 'crossover_rad_s')
            + ('bandwidth_rad_s',)
        ),
    }


def test_a_loop_that_needs_its_gain_has_a_reduction_margin():
    """L = 3/(s - 1): the closed loop s + k - 1 is stable for every gain k above 1."""
    margins = loop_margins(ContinuousLoop(FactoredTransferFunction(3.0, (), (-1.0,))))
    assert margins.gain_reduction_margin_db == pytest.approx(20.0 * math.log10(3.0), abs=1e-9)
    assert margins.gain_margin_db == math.inf


def test_the_higher_of_two_peaks_is_found_where_the_grid_ranks_them_the_other_way():
    """A local maximum a few percent lower on the grid is solved for too."""
    curve = LoopCurve(ContinuousLoop(FactoredTransferFunction(1.0, (), (0.0, 1.0))))
    low, high = curve.omega[400], math.sqrt(curve.omega[700] * curve.omega[701])

    def two_peaks(values: np.ndarray) -> np.ndarray:
        # |L|^2 = 1/(w^2 (w^2 + 1)) gives w; the second peak is between two points of 0.97.
        square = np.abs(values) ** -2.0
        at = 0.5 * np.log((np.sqrt(1.0 + 4.0 * square) - 1.0) / 2.0)
        width = 3.0 * math.log(curve.omega[701] / curve.omega[700])
        first = 0.99 * np.exp(-(((at - math.log(low)) / width) ** 2))
        return first + np.exp(-(((at - math.log(high)) / width) ** 2))

    assert two_peaks(curve.values).max() == pytest.approx(0.99, abs=1e-9)
    assert curve.peak(two_peaks) == pytest.approx((1.0, high), rel=1e-6)


def test_the_bandwidth_is_the_lowest_frequency_at_which_t_falls_by_3_db():
    """It is found on a grid of a million points; T rises through that level again later."""
    factored = THIRD_OF_FIVE
    omega = np.geomspace(1e-2, 1e2, 1_000_001)
    values = factored.frequency_response(omega)
    below = np.abs(values / (1.0 + values)) < math.sqrt(0.5)
    assert np.count_nonzero(below[1:] != below[:-1]) > 2
    found = loop_margins(ContinuousLoop(factored)).bandwidth_rad_s
    assert found == pytest.approx(omega[np.argmax(below)], rel=2e-5)


def test_a_weak_loop_never_crosses_over():
    margins = loop_margins(ContinuousLoop(FactoredTransferFunction(0.5, (), (1.0,))))
    assert margins.crossover_rad_s == 0.0
    assert margins.bandwidth_rad_s == 0.0
    assert margins.phase_margin_deg == math.inf
    assert margins.delay_margin_s == math.inf


@pytest.mark.parametrize(('delay_s', 'poles'), [(1.5, 0), (1.6, 2), (7.8, 2), (7.9, 4)])
def test_dead_time_around_an_integrator_moves_two_poles_at_a_time(delay_s, poles):
    """1 + exp(-s tau)/s: pairs cross at tau = pi/2, 5 pi/2, ..."""
    loop = ContinuousLoop(FactoredTransferFunction(1.0, (), (0.0,)), delay_s)
    assert unstable_poles(loop) == poles


def test_dead_time_can_stabilise_a_loop_that_is_unstable_without():
    """L = -0.5/(s^2 - 0.02 s + 1): a delay makes the feedback of position one of speed."""
    import control

    oscillator = FactoredTransferFunction(-0.5, (), ((-0.02, 1.0),))
    stable = [closed_loop_stable(ContinuousLoop(oscillator, delay)) for delay in (0.0, 1.0, 6.2)]
    pade = [0]
    for delay in (1.0, 6.2):
        approximation = control.tf(*control.pade(delay, 12))
        loop = control.tf([-0.5], [1.0, -0.02, 1.0]) * approximation
        pade.append(int(np.all(control.feedback(loop, 1).poles().real < 0.0)))
    assert stable == [bool(value) for value in pade]
    assert any(stable)


@pytest.mark.parametrize('name', ['ls2', 'ls7', 'hinf2'])
@pytest.mark.parametrize('delay_s', [0.01, 0.03, 0.05])
def test_dead_time_counts_as_a_high_order_pade_approximation_does(name, delay_s):
    import control

    controller = PRINTED_CONTROLLERS[name]
    loop = of_control(continuous_loop(controller).to_state_space())
    pade = control.tf2ss(*control.pade(delay_s, 6))
    poles = control.feedback(loop * pade, 1).poles()
    found = continuous_loop(controller, delay_s=delay_s)
    assert closed_loop_stable(found) == bool(np.all(poles.real < 0.0))
    without = loop_margins(continuous_loop(controller)).delay_margin_s
    assert closed_loop_stable(found) == (delay_s < without)
    if closed_loop_stable(found):
        assert loop_margins(found).delay_margin_s == pytest.approx(without - delay_s, rel=1e-6)
