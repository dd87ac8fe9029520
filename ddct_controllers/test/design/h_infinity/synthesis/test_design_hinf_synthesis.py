# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Riccati synthesis: optimal, verified, and named errors for what has no solution."""

import builtins
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.design.h_infinity import problem as hinf_problem
from ddct_controllers.design.h_infinity.design import design_h_infinity, generalised_plant
from ddct_controllers.design.h_infinity.problem import mixed_sensitivity
from ddct_controllers.design.h_infinity.recipes import HinfWeights, make_weights
from ddct_controllers.design.h_infinity.synthesis import gamma_iteration as riccati_synthesis
from ddct_controllers.design.h_infinity.synthesis import lmi as lmi_synthesis
from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import (
    synthesise,
    verified_norm,
)
from ddct_controllers.design.h_infinity.synthesis.generalised_plant import (
    GeneralisedPlant,
    balanced,
)
from ddct_controllers.design.h_infinity.synthesis.lmi import synthesise_by_lmi
from ddct_controllers.design.h_infinity.synthesis.riccati import (
    central_controller,
    stabilising_solutions,
)
from ddct_controllers.design.h_infinity.weights import SensitivityWeight
from ddct_controllers.design.loop_shaping.specifications import (
    TimeSpecifications,
)
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.models.parameters import DrivelineParameters

PRINTED = make_weights('thesis')
W_1, W_2 = PRINTED.sensitivity.shifted(), PRINTED.complementary.transfer_function()
PRINTED_OPTIMUM = 1.105


def simple_plant(**changes: Any) -> GeneralisedPlant:
    """Return dx/dt = x + w_1 + u, v = x + w_2, z = [x; u]: unstable, every matrix by hand."""
    parts: dict[str, Any] = {
        'a': [[1.0]],
        'b': [[1.0, 0.0, 1.0]],
        'c': [[1.0], [0.0], [1.0]],
        'd': [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
    }
    return GeneralisedPlant(StateSpace(**(parts | changes)))


def optimum(weights: HinfWeights) -> float:
    return synthesise(generalised_plant(weights)).optimum


def test_a_problem_with_a_closed_form_is_solved():
    """
    The plant of `simple_plant` has the optimum that its two Riccati equations give by hand.

    Both are 2 x + 1 - (1 - g^-2) x^2 = 0, so X = Y = (1 + sqrt(2 - g^-2)) / (1 - g^-2), and the
    least g has X Y = g^2. Within the 1e-4 of the iteration.
    """
    low, high = 1.0 + 1e-9, 100.0
    for _ in range(100):
        g = math.sqrt(low * high)
        x = (1.0 + math.sqrt(2.0 - g**-2)) / (1.0 - g**-2)
        low, high = (g, high) if x > g else (low, g)
    found = synthesise(simple_plant(), 1.0)
    assert found.optimum == pytest.approx(high, rel=2e-4)
    assert found.gamma == pytest.approx(high, rel=1e-3)


def test_the_printed_weights_have_the_optimum_1_105():
    """It is above 1: no controller has the norm below 1 that Section 3.1 requires of the stack."""
    assert optimum(PRINTED) == pytest.approx(PRINTED_OPTIMUM, abs=5e-4)
    assert synthesise(generalised_plant(PRINTED)).lower_bound > 1.0


@pytest.mark.parametrize('shift', [1e-6, 1e-3])
def test_where_the_plants_pole_at_zero_is_moved_to_does_not_matter(monkeypatch, shift):
    """The optimum changes by less than 0.1 %."""
    monkeypatch.setattr(hinf_problem, 'AXIS_SHIFT_RAD_S', shift)
    assert optimum(PRINTED) == pytest.approx(PRINTED_OPTIMUM, rel=1e-3)


@pytest.mark.parametrize('offset', [0.003, 0.0095, 0.09])
def test_epsilon_hardly_matters(offset):
    """From 0.001 to 0.03 of w_1 = 3 rad/s, the thesis's 0.0095 among them: within 1 %."""
    w_s = PRINTED.sensitivity.transfer_function()
    moved = FactoredTransferFunction(w_s.gain, w_s.numerator, (offset, offset))
    found = synthesise(mixed_sensitivity(plant_in_rpm(), moved, W_2))
    assert found.optimum == pytest.approx(PRINTED_OPTIMUM, rel=0.01)


def test_the_improper_w_2_is_exact():
    """z_2 = W_2 y by states alone: its response to u is W_2 times the plant's, within 1e-9."""
    problem = mixed_sensitivity(plant_in_rpm(), W_1, W_2)
    omega = np.geomspace(1e-2, 1e4, 30)
    a, b, c, d = (getattr(problem.system, name) for name in 'abcd')
    found = np.array(
        [(c[1] @ np.linalg.solve(1j * w * np.eye(len(a)) - a, b[:, 1]) + d[1, 1]) for w in omega]
    )
    shifted = hinf_problem.off_axis(plant_in_rpm())
    expected = W_2.frequency_response(omega) * shifted.frequency_response(omega)
    assert found == pytest.approx(expected, rel=1e-9)
    assert d[1, 1] != 0.0
    assert len(a) == 10


def test_the_closed_loop_has_the_level_that_the_riccati_equations_promise():
    """At every level down to 1e-4 above the optimum the norm is below it, and no more than 1 %."""
    problem = balanced(generalised_plant(PRINTED))
    for level in (3.0, 1.5, 1.2, 1.12, 1.106, 1.1051):
        controller = central_controller(problem, level, *stabilising_solutions(problem, level))
        norm = verified_norm(problem, controller)
        assert norm <= level * (1.0 + 1e-6)
    assert norm == pytest.approx(level, rel=1e-5)


def test_below_the_optimum_the_riccati_equations_have_solutions_and_the_loop_is_unstable():
    """Hence a controller is accepted only after its closed loop has been checked."""
    problem = balanced(generalised_plant(PRINTED))
    controller = central_controller(problem, 1.08, *stabilising_solutions(problem, 1.08))
    assert verified_norm(problem, controller) == math.inf


@pytest.mark.parametrize(('method', 'excess'), [('riccati', 2e-5), ('lmi', 0.02)])
def test_a_closed_loop_above_the_promised_level_is_refused(monkeypatch, method, excess):
    """It is stable, but above the level of the Riccati solutions or the LMIs."""
    if method == 'lmi':
        pytest.importorskip('clarabel', reason='the LMI method needs clarabel')
    levels = []

    def promised(plant, gamma, x, y):
        levels.append(gamma)
        return central_controller(plant, gamma, x, y)

    for module in (riccati_synthesis, lmi_synthesis):
        monkeypatch.setattr(module, 'central_controller', promised)
        monkeypatch.setattr(module, 'verified_norm', lambda *_: levels[-1] * (1.0 + excess))
    with refused(DdctError, 'weights'):
        (synthesise_by_lmi if method == 'lmi' else synthesise)(simple_plant())


def test_one_percent_above_the_optimum_the_fast_pole_is_gone():
    """The fastest pole moves from above 1e5 to below 300 rad/s."""
    problem = generalised_plant(PRINTED)
    at_optimum, above = (
        np.abs(np.linalg.eigvals(synthesise(problem, factor).controller.a)).max()
        for factor in (1.0, 1.01)
    )
    assert at_optimum > 1e5
    assert above < 300.0


def test_the_level_does_not_depend_on_the_last_bits_of_the_plant():
    """Norms near the optimum do, in their 7th digit, and the gain changes by 100 times that."""
    driveline = DrivelineParameters()
    gains = []
    for number in range(4):
        inertia = driveline.engine_inertia * (1.0 + number * 2.0**-50)
        changed = replace(driveline, engine_inertia=inertia)
        gains.append(design_h_infinity(PRINTED, changed).cleaned.gain)
    assert len(set(gains)) > 1
    assert gains == pytest.approx([gains[0]] * 4, rel=1e-8)


def test_feedthrough_of_the_plant_is_taken_into_account():
    """The closed loop with D22, and the optimum, are those without it."""
    d22 = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.7]]
    found = synthesise(simple_plant(d=d22), 1.0)
    assert found.optimum == pytest.approx(synthesise(simple_plant(), 1.0).optimum, rel=2e-4)
    assert verified_norm(simple_plant(d=d22), found.controller) == pytest.approx(found.gamma)


@pytest.mark.parametrize(
    ('changes', 'key'),
    [
        ({'b': [[1.0, 0.0, 0.0]]}, 'stabilisable'),
        ({'c': [[1.0], [0.0], [0.0]]}, 'detectable'),
        (
            {'d': [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]},
            'W_2',
        ),
        (
            {'d': [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]},
            'reference',
        ),
    ],
)
@pytest.mark.parametrize('method', [synthesise, synthesise_by_lmi])
def test_a_plant_without_a_solution_is_named(method, changes, key):
    if method is synthesise_by_lmi:
        pytest.importorskip('clarabel', reason='the LMI method needs clarabel')
    with refused(DdctError, key):
        method(simple_plant(**changes))


def test_the_thesis_constant_w_2_alone_has_no_solution():
    """W_2* = 1/T_p of Section 3.2.2, before `sderiv`, weighs nothing at high frequency."""
    plant = mixed_sensitivity(plant_in_rpm(), W_1, FactoredTransferFunction(1.0 / 1.02))
    with refused(DdctError, 'W_2'):
        synthesise(plant)


def test_an_unstable_w_1_is_named():
    """W_s with its poles at 0 keeps no loop from being stable, but no controller can move them."""
    with refused(ParameterError, key='W_1'):
        mixed_sensitivity(plant_in_rpm(), PRINTED.sensitivity.transfer_function(), W_2)


def test_a_w_2_with_too_many_zeros_is_named():
    third = W_2 * FactoredTransferFunction(1.0, (100.0,))
    with refused(ParameterError, 'W_2'):
        mixed_sensitivity(plant_in_rpm(), W_1, third)


def test_an_undamped_plant_pole_is_named():
    plant = FactoredTransferFunction(1.0, (), ((0.0, 9.0),))
    with pytest.raises(DdctError, match='undamped pole at .*3j rad/s'):
        mixed_sensitivity(plant, W_1, W_2)


def test_a_plant_that_blocks_at_rest_has_no_small_s_there():
    """s/(s + 1)^3: S(0) = 1, so that the stack is at least W_1*(0), which is in the thousands."""
    plant = FactoredTransferFunction(1.0, (0.0,), (1.0, 1.0, 1.0))
    at_rest = abs(W_1.frequency_response(np.zeros(1))[0])
    assert at_rest > 1000.0
    found = synthesise(mixed_sensitivity(plant, W_1, W_2))
    assert found.lower_bound == pytest.approx(at_rest, rel=0.01)


def test_weights_far_from_one_are_named():
    huge = FactoredTransferFunction(1e9) * W_1
    with refused(DdctError, 'weights'):
        synthesise(mixed_sensitivity(plant_in_rpm(), huge, W_2))


@pytest.mark.parametrize('recipe', ['thesis', 'sampled'])
def test_specifications_that_no_controller_meets_are_named(recipe):
    wanted = TimeSpecifications(rise_time_s=0.02, overshoot=0.08)
    with refused(ParameterError, 'rise time'):
        design_h_infinity(make_weights(recipe, wanted))


def test_bounds_on_s_and_t_that_exclude_each_other_are_named():
    weights = make_weights('thesis', bandwidth_rad_s=2.0)
    with refused(ParameterError, 'rise time'):
        design_h_infinity(weights)


def test_a_design_that_hold_and_delay_make_unstable_is_not_returned():
    wanted = TimeSpecifications(rise_time_s=0.05, overshoot=0.08)
    with pytest.raises(DdctError, match='loop with hold and delay unstable.*sampled'):
        design_h_infinity(make_weights('thesis', wanted))


def test_the_back_off_is_at_least_one():
    with refused(ParameterError, key='back-off from the optimum'):
        design_h_infinity(make_weights('thesis', back_off=0.9))


def test_a_peak_below_one_is_refused_before_any_synthesis():
    with refused(ParameterError, 'S_p'):
        SensitivityWeight(0.15, 1.0)


def test_the_error_of_the_lmi_method_without_clarabel_names_the_package(monkeypatch):
    original = builtins.__import__

    def missing(name, *args, **kwargs):
        if name == 'clarabel':
            raise ImportError(name)
        return original(name, *args, **kwargs)

    monkeypatch.setattr(builtins, '__import__', missing)
    with pytest.raises(DdctError, match='pip install clarabel, or use the Riccati method'):
        design_h_infinity(PRINTED, method='lmi')


def test_an_unknown_method_lists_the_known_ones():
    with refused(ParameterError, key='method'):
        design_h_infinity(PRINTED, method='guess')
