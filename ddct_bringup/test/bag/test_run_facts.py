# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The facts of a run are written to and read from a bag's custom data unchanged."""

import dataclasses
import math

import pytest
from refusals import refused

from ddct_bringup.bag.run_facts import RunFacts
from ddct_plant.base.errors import DdctError

FACTS = RunFacts(
    controller='pi',
    architecture='detailed',
    scenario='thesis',
    clutch='linear',
    wear_gain=math.nextafter(0.7, 1.0),
    mode='lockstep',
    seed=7,
    control_start_s=0.6,
    score_window_s=(0.6, 2.5),
    duration_s=3.0,
)
NAMES = ('controller', 'architecture', 'scenario', 'clutch', 'mode')


def test_facts_come_back_to_the_last_bit():
    custom_data = FACTS.to_custom_data()
    assert all(isinstance(value, str) for value in custom_data.values())
    assert RunFacts.from_custom_data({**custom_data, 'commit': 'abc'}) == FACTS


@pytest.mark.parametrize('name', ['controller', 'seed', 'score_window_s'])
def test_a_missing_fact_is_named(name):
    custom_data = FACTS.to_custom_data()
    del custom_data[name]
    with refused(DdctError, name):
        RunFacts.from_custom_data(custom_data)


def test_a_handover_of_a_bag_is_a_name_and_no_file_that_would_run():
    custom_data = {**FACTS.to_custom_data(), 'off_going_wear_gain': '1.0'}
    assert RunFacts.from_custom_data({**custom_data, 'handover': 'mine'}).handover == 'mine'
    for file in ('mine.py', '../mine.py'):
        with refused(DdctError, 'handover'):
            RunFacts.from_custom_data({**custom_data, 'handover': file})


def test_the_largest_seed_comes_back():
    facts = dataclasses.replace(FACTS, seed=2**31 - 1)
    assert RunFacts.from_custom_data(facts.to_custom_data()) == facts


@pytest.mark.parametrize(
    ('name', 'text'),
    [
        ('wear_gain', 'much'),
        ('wear_gain', 'true'),
        ('seed', '[1]'),
        ('score_window_s', '0.6'),
        ('score_window_s', '[0.6]'),
        ('score_window_s', '[0.6, "a"]'),
        ('score_window_s', '[0.6, true]'),
        ('seed', '1e400'),
        ('seed', 'NaN'),
        ('duration_s', '1' + '0' * 400),
        ('duration_s', '{"a": 1, "a": 2}'),
        *((name, '../../evil') for name in NAMES),
        *((name, '\x1b[31mred') for name in NAMES),
        *((name, '</script>') for name in NAMES),
        ('controller', 'x' * 300),
        ('scenario', ''),
    ],
)
def test_an_unusable_fact_is_named(name, text):
    with refused(DdctError, name) as caught:
        RunFacts.from_custom_data({**FACTS.to_custom_data(), name: text})
    assert str(caught.value).isprintable()
