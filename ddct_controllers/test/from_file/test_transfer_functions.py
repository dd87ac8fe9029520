# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Four forms of one controller are one controller; errors name the line."""

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.design.state_space import factored_form, frequency_response
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
LS8 = PRINTED_CONTROLLERS['ls8']
HEAD = 'name: mine\nunits: {input: rpm, output: N m}\n'
OMEGA = np.geomspace(0.01, 300.0, 200)


@pytest.fixture
def write(tmp_path):
    def write_text(text):
        path = tmp_path / 'any.yaml'
        path.write_text(text, encoding='utf-8')
        return str(path)

    return write_text


@pytest.fixture
def model(write):
    def linear_model(text) -> StateSpace:
        return make_controller(write(HEAD + text), SETTINGS.known).linear_model()

    return linear_model


def forms(zeros, poles, gain):
    """Return the forms of one system as YAML, by kind, made by scipy."""
    from scipy import signal

    num, den = signal.zpk2tf(zeros, poles, gain)
    a, b, c, d = (np.asarray(matrix).tolist() for matrix in signal.zpk2ss(zeros, poles, gain))
    roots = [[str(complex(root)).strip('()') for root in side] for side in (zeros, poles)]
    return {
        'polynomial': f'polynomial: {{num: {num.tolist()}, den: {den.tolist()}}}\n',
        'zeros_poles_gain': (
            f'zeros_poles_gain: {{zeros: {roots[0]}, poles: {roots[1]}, gain: {gain}}}\n'
        ),
        'state_space': f'state_space: {{a: {a}, b: {b}, c: {c}, d: {d}}}\n',
    }


@pytest.mark.parametrize('kind', ['polynomial', 'zeros_poles_gain', 'state_space'])
@pytest.mark.parametrize('method', ['hold', 'bilinear'])
def test_every_form_is_the_same_controller_as_scipy_samples_it(model, kind, method):
    from scipy import signal

    text = forms(LS8.zeros, LS8.poles, LS8.gain)[kind]
    found = frequency_response(model(f'{text}discretisation: {method}\n'), OMEGA)
    names = {'hold': 'zoh', 'bilinear': 'bilinear'}
    by_scipy = signal.cont2discrete(
        signal.zpk2ss(LS8.zeros, LS8.poles, LS8.gain), 0.01, names[method]
    )
    _, expected = signal.dfreqresp(signal.dlti(*by_scipy[:4], dt=0.01), OMEGA * 0.01)
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_zero_order_hold_is_the_default_discretisation(model):
    text = forms(LS8.zeros, LS8.poles, LS8.gain)['polynomial']
    held = model(f'{text}discretisation: hold\n')
    for name in 'abcd':
        np.testing.assert_array_equal(getattr(model(text), name), getattr(held, name))


@pytest.mark.parametrize(
    'kind', ['transfer_function', 'polynomial', 'zeros_poles_gain', 'state_space']
)
def test_a_sampled_form_is_run_as_it_is(model, kind):
    """The poles and zeros in the file are those of the z-plane."""
    zeros, gain = np.array([0.9]), -0.02
    poles = np.array([1.0, 0.5 + 0.2j, 0.5 - 0.2j])
    texts = forms(zeros, poles, gain) | {
        'transfer_function': (
            'transfer_function: {gain: -0.02, numerator: [-0.9], '
            'denominator: [-1.0, [-1, 0.29]]}\n'
        )
    }
    found = factored_form(model(f'{texts[kind]}sample_time_s: 0.01\n'))
    assert found.gain == pytest.approx(gain)
    np.testing.assert_allclose(found.zeros, zeros)
    np.testing.assert_allclose(np.sort_complex(found.poles), np.sort_complex(poles), rtol=1e-6)


def test_a_state_space_may_leave_out_brackets_around_single_numbers(model):
    found = model('state_space: {a: [[0, 1], [-2, -3]], b: [0, 1], c: [4, 5], d: 6}\n')
    assert found.c.tolist() == [[4.0, 5.0]]
    assert found.d.tolist() == [[6.0]]


def test_a_pure_gain_has_no_states(model):
    assert model('state_space: {a: [], b: [], c: [], d: -0.1}\n').d.tolist() == [[-0.1]]
    assert model('polynomial: {num: [-0.1], den: [1]}\n').d.tolist() == [[-0.1]]


POLYNOMIAL = 'polynomial:\n  num: [-1, 2]\n  den: [1, 3]\n'
ROOTS = 'zeros_poles_gain:\n  zeros: [-1]\n  poles: [-1+2j, -1-2j]\n  gain: -1\n'
STATES = 'state_space:\n  a: [[0, 1], [-2, -3]]\n  b: [0, 1]\n  c: [4, 5]\n  d: 0\n'


@pytest.mark.parametrize(
    ('text', 'old', 'new', 'line', 'key'),
    [
        (
            POLYNOMIAL,
            'num: [-1, 2]',
            'num: [1, 2, 3]',
            3,
            'polynomial',
        ),
        (POLYNOMIAL, '[1, 3]', '[0, 0]', 3, 'polynomial'),
        (POLYNOMIAL, '[1, 3]', '[1, -1.0e+6]', 3, 'polynomial'),
        (POLYNOMIAL, '[1, 3]', '[1e-308, 1e308, 1]', 3, 'polynomial'),
        (POLYNOMIAL, '[-1, 2]', '[-1, .nan]', 4, 'polynomial.num[1]'),
        (POLYNOMIAL, '[-1, 2]', '[-1, fast]', 4, 'polynomial.num[1]'),
        (POLYNOMIAL, '[-1, 2]', '-1', 4, 'polynomial.num'),
        (POLYNOMIAL, 'num:', 'mun:', 3, 'polynomial.num'),
        (POLYNOMIAL, 'den:', 'gain: 2\n  den:', 5, 'polynomial.gain'),
        (POLYNOMIAL, 'polynomial:', 'discretization: hold\npolynomial:', 3, 'discretization'),
        (POLYNOMIAL, 'polynomial:', 'discretisation: zoh\npolynomial:', 3, 'discretisation'),
        (POLYNOMIAL, '[1, 3]', '[1, -200]\ndiscretisation: bilinear', 3, 'polynomial'),
        (POLYNOMIAL, 'polynomial:', 'sample_time_s: 0.02\npolynomial:', 3, 'sample_time_s'),
        (POLYNOMIAL, 'polynomial:', 'sample_time_s: fast\npolynomial:', 3, 'sample_time_s'),
        (
            POLYNOMIAL,
            'polynomial:',
            'sample_time_s: 0.01\ndiscretisation: hold\npolynomial:',
            4,
            'discretisation',
        ),
        (ROOTS, '-1+2j, -1-2j', '-1+2j, -1-3j', 3, 'zeros_poles_gain'),
        (ROOTS, '-1+2j, -1-2j', '-1+2j', 3, 'zeros_poles_gain'),
        (ROOTS, '-1+2j', '-1+2k', 5, 'zeros_poles_gain.poles[0]'),
        (ROOTS, '-1+2j', 'nan+2j', 5, 'zeros_poles_gain.poles[0]'),
        (ROOTS, '-1+2j', '1e999+2j', 5, 'zeros_poles_gain.poles[0]'),
        (STATES, '[-2, -3]]', '[-2]]', 4, 'state_space.a'),
        (STATES, 'b: [0, 1]', 'b: [0, 1, 2]', 5, 'state_space.b'),
        (STATES, 'c: [4, 5]', 'c: [[4, 5], [6, 7]]', 6, 'state_space.c'),
        (STATES, 'd: 0', 'd: .inf', 7, 'state_space.d'),
    ],
)
def test_a_controller_that_cannot_run_is_named_with_file_and_line(
    write, text, old, new, line, key
):
    assert old in text
    file = write(HEAD + text.replace(old, new))
    with refused(ParameterError, key=key, place=f'controller file {file}: line {line}'):
        make_controller(file, SETTINGS.known)


@pytest.mark.parametrize('units', ['{input: rad/s, output: N m}', '{input: rpm}', 'rpm', ''])
def test_a_file_states_the_units_of_the_loop_or_is_refused(write, units):
    text = f'name: mine\nunits: {units}\n{POLYNOMIAL}'
    with refused(DdctError, key='units', place='any.yaml: line 2'):
        make_controller(write(text), SETTINGS.known)
