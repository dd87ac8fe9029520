# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Before a run the content of a controller's file and the stability of its loop are printed."""

import pytest

from ddct_controllers.registry import make_controller
from ddct_controllers.workflows.evidence import loop_evidence
from ddct_controllers.workflows.loop_summary import formula, loop_summary
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

SCENARIO = load_scenario('thesis')
SETTINGS = RunSettings(KnownSettings(SCENARIO))
HEAD = 'name: mine\nunits: {input: rpm, output: N m}\n'
POLYNOMIAL = 'polynomial: {num: [-0.035, -0.8, -1.1], den: [1, 8, 0]}\n'


@pytest.fixture
def summary(tmp_path):
    def lines(text, settings=SETTINGS):
        path = tmp_path / 'any.yaml'
        path.write_text(HEAD + text)
        return loop_summary(str(path), settings)

    return lines


@pytest.mark.parametrize(
    ('function', 'expected'),
    [
        (FactoredTransferFunction(-2.0), '-2'),
        (FactoredTransferFunction(2.0, (), (0.0,)), '2 / s'),
        (
            FactoredTransferFunction(1.0, (-3.0,), (0.0, (2.0, -5.0))),
            '1 (s - 3) / [s (s^2 + 2 s - 5)]',
        ),
    ],
)
def test_a_formula_is_written_as_a_reader_does(function, expected):
    assert formula(function, 's') == expected


def test_a_continuous_controller_is_shown_as_it_was_given_and_as_it_runs(summary):
    given, run, _ = summary(POLYNOMIAL + 'discretisation: bilinear\n')
    assert given == 'mine: G_c(s) = -0.035 (s + 1.46947) (s + 21.3877) / [s (s + 8)]'
    assert run.startswith('mine: G_c(z) = -0.0')
    assert ', by bilinear rule, every 10 ms, from slip error in rpm to torque in N m' in run
    assert ', by zero-order hold, ' in summary(POLYNOMIAL)[1]
    by_states = summary('state_space: {a: [[0]], b: [1], c: [-0.7], d: -0.1}\n')
    assert by_states[0] == 'mine: G_c(s) = -0.1 (s + 7) / s'


def test_a_sampled_controller_is_shown_as_it_is(summary):
    run, stability = summary('polynomial: {num: [-0.1], den: [1, -1]}\nsample_time_s: 0.01\n')
    assert run.startswith('mine: G_c(z) = -0.1 / (z - 1), every 10 ms')
    assert 'loop' in stability


@pytest.mark.parametrize('wear_gain', [1.0, 1.3])
def test_a_stable_loop_has_the_margins_of_the_evidence(summary, tmp_path, wear_gain):
    settings = RunSettings(
        KnownSettings(load_scenario('thesis')), CaseSettings(wear_gain=wear_gain)
    )
    stability = summary(POLYNOMIAL, settings)[-1]
    model = make_controller(str(tmp_path / 'any.yaml'), settings.known).linear_model()
    margins = loop_evidence(model, SCENARIO.driveline, wear_gain, SCENARIO.actuator).margins
    assert f'at wear gain {wear_gain:g}, is stable: ' in stability
    assert f'gain margin {margins.gain_margin_db:.1f} dB' in stability
    assert f'phase margin {margins.phase_margin_deg:.0f} deg' in stability


def test_an_unstable_loop_is_printed_in_capitals_and_a_wrong_sign_is_suspected(summary):
    assert 'UNSTABLE: ' in summary('polynomial: {num: [-50], den: [1, 0]}\n')[-1]
    stability = summary('polynomial: {num: [0.035, 0.8, 1.1], den: [1, 8, 0]}\n')[-1]
    assert (
        'has 1 pole on or outside the unit circle; -G_c is stable: is the sign wrong?' in stability
    )


def test_the_loop_has_the_actuator_of_the_scenario(summary):
    slow = RunSettings(KnownSettings(load_scenario('thesis', ['actuator.delay_s=0.9'])))
    assert 'is stable: ' in summary(POLYNOMIAL)[-1]
    assert 'UNSTABLE: ' in summary(POLYNOMIAL, slow)[-1]


def test_a_controller_that_is_not_linear_has_no_summary():
    assert loop_summary('mpc3', SETTINGS) == []
