# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The facts that scoring needs come from the settings of a run, and from its bag unchanged."""

import math

import pytest
from refusals import refused

from ddct_bringup.bag.run_facts import RunConditions, RunFacts, ShiftConditions, described_run
from ddct_bringup.run.description import custom_data
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

NAMES = ('controller', 'architecture', 'scenario', 'mode')
LAUNCH = RunSettings(
    KnownSettings(load_scenario('thesis')),
    CaseSettings(wear_gain=math.nextafter(0.7, 1.0), seed=2**31 - 1),
)
SHIFT = RunSettings(
    KnownSettings(load_scenario('upshift'), handover='/home/somebody/mine.py'),
    CaseSettings(off_going_wear_gain=0.9),
)


def test_facts_are_those_of_the_settings():
    facts = RunFacts.of(LAUNCH, 'pi', 150)
    assert (facts.controller, facts.scenario, facts.duration_s) == ('pi', 'thesis', 1.5)
    assert (facts.wear_gain, facts.seed) == (math.nextafter(0.7, 1.0), 2**31 - 1)
    assert (facts.control_start_s, facts.score_window_s) == (0.6, (0.6, 1.7))
    assert (facts.handover, facts.off_going_wear_gain, facts.of_shift) == (None, None, None)


def test_facts_of_a_shift_have_the_name_of_its_handover():
    facts = RunFacts.of(SHIFT, 'pi', 250)
    assert facts.of_shift == ShiftConditions(0.9, 'mine')


@pytest.mark.parametrize('settings', [LAUNCH, SHIFT], ids=['launch', 'shift'])
def test_facts_come_back_to_the_last_bit(settings):
    _, facts = described_run(custom_data(settings, 'pi', 120))
    assert facts == RunFacts.of(settings, 'pi', 120)


@pytest.mark.parametrize('name', NAMES)
@pytest.mark.parametrize('text', ['../../evil', '</script>', '\x1b[31mred', ''])
def test_an_unusable_name_is_named(name, text):
    names = dict.fromkeys(NAMES, 'a') | {name: text}
    with refused(ParameterError, name):
        RunConditions(**names, wear_gain=1.0, seed=0)
