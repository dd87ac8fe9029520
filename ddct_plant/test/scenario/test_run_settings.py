# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings that contradict each other are refused; the start state fits the architecture."""

from dataclasses import replace

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import make_driveline
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS = load_scenario('thesis')
EARLY_END = load_scenario('thesis', ['reference.reference_end_s=0.6'])


def test_an_unknown_architecture_lists_all_four():
    with refused(ParameterError, key='architecture'):
        RunSettings(KnownSettings(THESIS, architecture='open_loop'))


def test_a_tanh_that_ends_no_later_than_control_starts_is_refused():
    with refused(ParameterError, key='reference.reference_end_s'):
        RunSettings(KnownSettings(EARLY_END, architecture='feedforward_tanh'))


@pytest.mark.parametrize('architecture', ['base', 'feedforward', 'detailed'])
def test_the_end_does_not_matter_to_a_ramp(architecture):
    assert RunSettings(KnownSettings(EARLY_END, architecture)).known.reference_shape == 'ramp'


@pytest.mark.parametrize('architecture', ARCHITECTURES)
def test_the_shape_of_the_scenario_is_taken_or_refused(architecture):
    scenario = load_scenario('thesis', ['reference.shape=polynomial'])
    if architecture == 'feedforward_tanh':
        with refused(ParameterError, key='reference.shape'):
            RunSettings(KnownSettings(scenario, architecture))
    else:
        assert (
            RunSettings(KnownSettings(scenario, architecture)).known.reference_shape
            == 'polynomial'
        )


def test_the_clutch_starts_open_but_for_the_detailed_architecture():
    scenario = load_scenario('thesis', ['engine.torque_n_m=[25.0, 308.0]'])
    for architecture in ARCHITECTURES:
        (side,) = initial_state(
            RunSettings(KnownSettings(scenario, architecture), CaseSettings(wear_gain=0.7))
        ).sides
        if architecture == 'detailed':
            assert side.torque_request > 20.0
            assert side.torque == 0.7 * side.torque_request
        else:
            assert (side.torque_request, side.torque) == (0.0, 0.0)


def test_a_driveline_that_sticks_and_cannot_be_integrated_is_named():
    scenario = load_scenario('thesis', ['driveline.shaft_inertia=0.0002'])
    settings = RunSettings(KnownSettings(replace(scenario, clutch='stick_slip')))
    with refused(ParameterError, 'driveline.shaft_inertia', place='scenario thesis'):
        make_driveline(settings, initial_state(settings))


def test_a_driveline_whose_elements_cannot_stick_together_is_no_scenario():
    given = [f'driveline.{name}_inertia=1e300' for name in ('engine', 'shaft', 'vehicle')]
    with refused(ParameterError, 'driveline.shaft_inertia', place='scenario thesis'):
        load_scenario('thesis', given)


def test_a_clutch_without_heat_capacity_is_refused():
    with refused(ParameterError, key='heat.plate_j_k'):
        load_scenario('thesis', ['heat.plate_j_k=0.5'])
