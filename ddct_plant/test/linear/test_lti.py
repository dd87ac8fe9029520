# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Realisation and discretisation against independent routes, and the thesis's printed G_c(z)."""

import numpy as np
import pytest
import scipy
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh, lift_piecewise_linear, lift_zoh_dense
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR, CLUTCH_TO_SLIP, LOAD_TO_SLIP, PrintedNumber

LS7 = FactoredTransferFunction(-0.012057, (0.8361, (74.29, 2393.0)), (0.0, (5.325, 339.3)))
HINF1 = FactoredTransferFunction(
    -0.012266,
    (0.7567, 0.009368, (82.23, 2563.0), (121.4, 7696.0), (134.1, 4.27e4)),
    (0.0, 138.0, 89.52, 0.005905, (5.344, 339.4), (146.2, 2.914e4)),
)
HINF2 = FactoredTransferFunction(
    -0.48353,
    (206.6, 7.48, 0.01008, (82.23, 2563.0), (121.4, 7696.0)),
    (0.0, 303.1, 202.0, 138.0, 0.01729, (5.344, 339.4)),
)
SYSTEMS = {
    'LS7': LS7,
    'Hinf1': HINF1,
    'Hinf2': HINF2,
    'G_a': ACTUATOR,
    'P2': CLUTCH_TO_SLIP.factored(),
    'P3': LOAD_TO_SLIP.factored(),
    'gain alone': FactoredTransferFunction(-3.0),
    'double integrator': FactoredTransferFunction(2.0, (), (0.0, 0.0)),
    'more real zeros than quadratic poles': FactoredTransferFunction(
        1.5, ((1.0, 4.0), (2.0, 900.0), -7.0), (1.0, 2.0, 3.0, 4.0, 5.0)
    ),
}
OMEGA = np.logspace(-4, 4, 60)


@pytest.mark.parametrize('name', SYSTEMS)
def test_realisation_has_the_frequency_response_of_its_factors(name):
    system = SYSTEMS[name]
    model = system.to_state_space()
    s = 1j * OMEGA
    expected = np.full(len(s), system.gain, dtype=complex)
    for roots, sign in ((system.zeros, 1), (system.poles, -1)):
        for root in roots:
            expected *= (s - root) ** sign
    realised = [
        (model.c @ np.linalg.solve(w * np.eye(len(model.a)) - model.a, model.b) + model.d)[0, 0]
        for w in s
    ]
    np.testing.assert_allclose(realised, expected, rtol=1e-9)
    np.testing.assert_allclose(system.frequency_response(OMEGA), expected, rtol=1e-11)


def test_a_product_is_the_product_of_the_values_anywhere_in_the_plane():
    first, second = ACTUATOR, CLUTCH_TO_SLIP.factored()
    product, points = first * second, np.array([1.0 + 2.0j, -30.0, 0.01j])
    by_roots = [
        product.gain * np.prod(s - product.zeros) / np.prod(s - product.poles) for s in points
    ]
    np.testing.assert_allclose(product.at(points), by_roots, rtol=1e-11)
    np.testing.assert_allclose(first.at(points) * second.at(points), by_roots, rtol=1e-11)


@pytest.mark.parametrize('name', SYSTEMS)
def test_realisation_has_one_state_per_pole_and_its_poles(name):
    system = SYSTEMS[name]
    poles = np.linalg.eigvals(system.to_state_space().a)
    assert len(poles) == len(system.poles)
    assert poly_distance(poles, system.poles) < 1e-9


def poly_distance(found: np.ndarray, expected: np.ndarray) -> float:
    """Return the largest distance between two sets of roots, relative to the largest root."""
    if not len(found):
        return 0.0
    distance = np.abs(found[:, None] - expected[None, :])
    return max(distance.min(axis=0).max(), distance.min(axis=1).max()) / max(
        np.abs(expected).max(), 1.0
    )


def test_improper_transfer_function_has_no_state_space():
    with refused(ParameterError, 'zeros'):
        FactoredTransferFunction(1.0, ((1.0, 1.0),), (3.0,)).to_state_space()


def test_not_a_number_is_refused():
    with refused(ParameterError, key='transfer function: a coefficient'):
        FactoredTransferFunction(1.0, (float('nan'),), (3.0, 4.0))
    with refused(ParameterError, 'b'):
        StateSpace(np.eye(1), np.array([[np.nan]]), np.eye(1), np.eye(1))


def test_state_space_refuses_shapes_that_do_not_fit_and_cannot_be_written():
    with refused(ParameterError, 'c'):
        StateSpace(np.eye(2), np.ones((2, 1)), np.ones((1, 3)), np.zeros((1, 1)))
    model = StateSpace(np.eye(1), np.eye(1), np.eye(1), np.eye(1))
    with pytest.raises(ValueError, match='read-only'):
        model.a[0, 0] = 2.0


def test_a_sampled_system_is_not_sampled_again():
    with pytest.raises(ParameterError, match='already sampled'):
        discretise_zoh(discretise_zoh(LS7.to_state_space(), 0.01), 0.01)


@pytest.mark.parametrize('name', ['LS7', 'Hinf1', 'G_a', 'P2'])
def test_zero_order_hold_agrees_with_scipy_and_control(name):
    import control
    from scipy.signal import cont2discrete

    model = SYSTEMS[name].to_state_space()
    sampled = discretise_zoh(model, 0.01)
    by_scipy = cont2discrete((model.a, model.b, model.c, model.d), 0.01)
    np.testing.assert_allclose(sampled.a, by_scipy[0], rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(sampled.b, by_scipy[1], rtol=1e-12, atol=1e-14)
    by_control = control.c2d(control.ss(model.a, model.b, model.c, model.d), 0.01)
    z = np.exp(1j * np.logspace(-1, 2.4, 20) * 0.01)
    ours = control.ss(sampled.a, sampled.b, sampled.c, sampled.d, 0.01)
    np.testing.assert_allclose(ours(z), by_control(z), rtol=1e-9)


def discrete_roots(system: FactoredTransferFunction) -> tuple[np.ndarray, np.ndarray, float]:
    """Return zeros, poles and gain of the 10 ms zero-order-hold form of a bi-proper system."""
    sampled = discretise_zoh(system.to_state_space(), 0.01)
    gain = sampled.d[0, 0]
    zeros = np.linalg.eigvals(sampled.a - sampled.b @ sampled.c / gain)
    return zeros, np.linalg.eigvals(sampled.a), gain


def assert_printed(roots: np.ndarray, real: list[str], pairs: list[tuple[str, str]]) -> None:
    """Assert that the roots round to real ones z - r and pairs z^2 + b z + c as printed."""
    found_real = sorted(roots[np.abs(roots.imag) < 1e-9].real)
    assert len(found_real) == len(real)
    for value, text in zip(found_real, sorted(real, key=float), strict=True):
        assert abs(value - float(text)) <= PrintedNumber('', text).half_unit
    upper = roots[roots.imag >= 1e-9]
    found_pairs = sorted((-2 * root.real, abs(root) ** 2) for root in upper)
    assert len(found_pairs) == len(pairs)
    for found, texts in zip(found_pairs, sorted(pairs, key=lambda p: float(p[0])), strict=True):
        for value, text in zip(found, texts, strict=True):
            assert abs(value - float(text)) <= PrintedNumber('', text).half_unit


def test_ls7_at_10_ms_is_the_printed_discrete_controller():
    zeros, poles, gain = discrete_roots(LS7)
    assert gain == pytest.approx(-0.012057, abs=1e-15)
    assert_printed(zeros, ['0.9917'], [('-1.144', '0.3769')])
    assert_printed(poles, ['1.0000'], [('-1.915', '0.9481')])


def test_hinf1_at_10_ms_is_the_printed_discrete_controller():
    zeros, poles, gain = discrete_roots(HINF1)
    assert gain == pytest.approx(-0.012266, abs=1e-15)
    assert_printed(
        zeros,
        ['0.9925', '0.9999'],
        [('-1.208', '0.3832'), ('-1.056', '0.5025'), ('0.1153', '0.4417')],
    )
    assert_printed(
        poles,
        ['0.4085', '0.2516', '0.9999', '1.0000'],
        [('-1.915', '0.9480'), ('-0.02714', '0.2318')],
    )


def test_piecewise_linear_input_is_integrated_exactly():
    model = driveline_matrices(DrivelineParameters())
    column = model.b[:, 1]
    start = np.array([160.0, 155.0, 17.0, 0.01])
    nodes = np.random.default_rng(3).uniform(0.0, 300.0, 11)
    times = np.linspace(0.0, 0.01, 11)
    state = start
    for first in range(10):
        state = scipy.integrate.solve_ivp(
            lambda t, x: model.a @ x + column * np.interp(t, times, nodes),
            times[first : first + 2],
            state,
            method='DOP853',
            rtol=1e-12,
            atol=1e-13,
        ).y[:, -1]
    a_d, gamma = lift_piecewise_linear(model.a, column, 0.01, 10)
    np.testing.assert_allclose(a_d @ start + gamma @ nodes, state, rtol=1e-11, atol=1e-13)


def test_equal_nodes_are_a_held_input():
    model = driveline_matrices(DrivelineParameters())
    held = discretise_zoh(model, 0.01)
    a_d, gamma = lift_piecewise_linear(model.a, model.b[:, 1:2], 0.01, 10)
    np.testing.assert_allclose(a_d, held.a, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(gamma.sum(axis=1), held.b[:, 1], rtol=1e-11, atol=1e-15)


def test_outputs_within_a_period_follow_the_differential_equation():
    model = ACTUATOR.to_state_space()
    start = np.array([3.0, -2.0, 5.0, 1.0])
    solution = scipy.integrate.solve_ivp(
        lambda t, x: model.a @ x + model.b[:, 0] * 120.0,
        (0.0, 0.01),
        start,
        method='DOP853',
        t_eval=np.linspace(0.0, 0.01, 11),
        rtol=1e-12,
        atol=1e-12,
    )
    a_d, b_d, outputs, feedthrough = lift_zoh_dense(model, 0.01, 10)
    assert outputs.shape == (11, 4) and feedthrough.shape == (11, 1)
    expected = (model.c @ solution.y)[0]
    np.testing.assert_allclose(outputs @ start + feedthrough[:, 0] * 120.0, expected, rtol=1e-9)
    np.testing.assert_allclose(a_d @ start + b_d[:, 0] * 120.0, solution.y[:, -1], rtol=1e-9)


def test_dense_outputs_with_feedthrough_are_those_of_ever_longer_holds():
    model = LS7.to_state_space()
    _, _, outputs, feedthrough = lift_zoh_dense(model, 0.01, 4)
    assert feedthrough[0, 0] == LS7.gain
    for node in range(1, 5):
        held = discretise_zoh(model, 0.0025 * node)
        np.testing.assert_allclose(outputs[node], (model.c @ held.a)[0], rtol=1e-11)
        np.testing.assert_allclose(feedthrough[node], (model.c @ held.b + model.d)[0], rtol=1e-11)


@pytest.mark.parametrize('intervals', [0, -3])
def test_lifting_needs_at_least_one_interval(intervals):
    with refused(ParameterError, key='intervals'):
        lift_zoh_dense(LS7.to_state_space(), 0.01, intervals)
    with refused(ParameterError, key='intervals'):
        lift_piecewise_linear(np.eye(2), np.ones(2), 0.01, intervals)
