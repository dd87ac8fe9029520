# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every controller declares whether it is computed from the scenario's driveline, correctly."""

import pytest

from ddct_controllers.interface import SCENARIO, THESIS
from ddct_controllers.registry import controller_names, controller_spec, make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

CHANGED = RunSettings(load_scenario('thesis', ['driveline.halfshaft_stiffness=8000']))
AS_IT_IS = RunSettings(load_scenario('thesis'))
LINEAR = [
    *('pi', 'ls1', 'ls8', 'hinf1', 'hinf3', 'lqi'),
    *('hinf_thesis', 'hinf_fitted', 'hinf_sampled'),
]


@pytest.mark.parametrize('name', LINEAR)
def test_a_linear_controller_changes_with_the_driveline_unless_it_is_the_thesiss(name):
    models = [make_controller(name, run).linear_model() for run in (AS_IT_IS, CHANGED)]
    assert models[0] is not None
    assert models[1] is not None
    same = all(
        getattr(models[0], part).tobytes() == getattr(models[1], part).tobytes() for part in 'abcd'
    )
    assert controller_spec(name).computed_from == (THESIS if same else SCENARIO)


def test_all_of_ours_declare_it_and_only_printed_or_tuned_ones_are_fixed():
    sources = {name: controller_spec(name).computed_from for name in controller_names()}
    fixed = [name for name, source in sources.items() if source == THESIS]
    assert fixed == ['pi', *(f'ls{i}' for i in range(1, 10)), 'hinf1', 'hinf2', 'hinf3']
    assert {sources[name] for name in ('mpc3', 'mpc4', 'mpc_wear', 'pedal_mpc')} == {SCENARIO}


def test_it_is_in_the_run_info_of_a_controller():
    assert make_controller('ls8', AS_IT_IS).info('ls8')['computed_from'] == THESIS
    assert make_controller('mpc3', AS_IT_IS).info('mpc3')['computed_from'] == SCENARIO
