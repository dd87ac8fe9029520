# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The architectures with a stored reference run in the scenarios for the clutch that sticks."""

import itertools
from functools import cache

import numpy as np
import pytest
from samples import sampled

from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

ALL_BUT_DETAILED = [name for name in ARCHITECTURES if name != 'detailed']
WITH_ONE_CLUTCH = [name for name in scenario_names() if not load_scenario(name).shift]
FOR_STICK_SLIP = [name for name in WITH_ONE_CLUTCH if load_scenario(name).of_stick_slip]


@cache
def run(name, architecture, wear_gain=1.0):
    settings = RunSettings(
        KnownSettings(load_scenario(name), architecture), CaseSettings(wear_gain=wear_gain)
    )
    return run_headless(settings, 'hinf1')


@pytest.mark.slow
@pytest.mark.parametrize(
    ('name', 'architecture'),
    sampled(itertools.product(FOR_STICK_SLIP, ALL_BUT_DETAILED), every=4),
)
def test_the_reference_is_the_slip_of_the_nominal_detailed_run_with_the_same_clutch(
    name, architecture
):
    start = load_scenario(name).control_start_step
    nominal = run(name, 'detailed')
    for wear_gain in (1.0, 0.7):
        worn = run(name, architecture, wear_gain)
        reference = worn.slip_reference[: start + 1, 0]
        np.testing.assert_array_equal(reference, nominal.slip_speed[: start + 1])
        assert np.all(np.isfinite(worn.slip_speed))


@pytest.mark.parametrize('architecture', ARCHITECTURES)
@pytest.mark.parametrize(('name', 'phase'), [('launch', 0.0), ('tip_in', 2.0)])
def test_the_clutch_starts_in_the_phase_of_the_scenario(name, phase, architecture):
    assert run(name, architecture).clutch_phase[0] == phase


def test_a_scenario_for_both_clutches_has_the_reference_of_the_linear_one():
    of_clutch = [
        run_headless(RunSettings(KnownSettings(load_scenario(name), 'base')), 'pi').slip_reference
        for name in ('thesis', 'thesis_sticking')
    ]
    np.testing.assert_array_equal(*of_clutch)
