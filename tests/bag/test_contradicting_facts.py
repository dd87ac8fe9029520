# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A bag whose facts contradict its scenario or its nodes is refused: its scores would differ."""

import json
from pathlib import Path

import pytest
from refusals import refused
from support.runs import plan, record

from ddct_bringup.bag.reader import read_bag
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml
from ddct_plant.scenario.file import content_digest


@pytest.fixture(scope='module')
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the bag of a run without a graph."""
    folder = tmp_path_factory.mktemp('recorded') / 'pi'
    record(plan('pi', 'headless'), folder)
    return folder


def test_the_facts_of_a_bag_agree(bags, recorded: Path) -> None:
    again = read_bag(bags.rewrite(recorded, 'again'))
    assert again.settings is not None
    assert again.trajectory.sha256() == read_bag(recorded).trajectory.sha256()


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('scenario', 'another'),
        ('control_start_s', 0.5),
        ('score_window_s', [0.7, 0.9]),
        ('duration_s', 1.5),
        ('duration_s', 0.9),
        ('controller', 'ls8'),
        ('architecture', 'base'),
        ('wear_gain', 0.8),
        ('seed', 5),
        ('mode', 'realtime'),
        ('mode', 'measured'),
        ('clutch', 'measured'),
    ],
)
def test_a_fact_that_was_edited_is_named(bags, recorded: Path, name: str, value: object) -> None:
    text = value if isinstance(value, str) else json.dumps(value)
    with refused(DdctError, name, place='odd.mcap'):
        read_bag(edited(bags, recorded, {name: text}))


def test_a_run_that_ended_early_does_not_become_a_whole_one(bags, recorded: Path) -> None:
    def first_half(messages):
        return [message for message in messages if message[1] <= stamp_of_step(50)]

    half = bags.rewrite(recorded, 'half', first_half)
    assert read_bag(half).trajectory.steps == 50
    with refused(DdctError, 'steps', place='odd.mcap'):
        read_bag(edited(bags, half, {'duration_s': '0.5'}))


@pytest.mark.parametrize('change', ['control_start_s', 'score_window_s', 'vehicle_inertia'])
def test_a_scenario_that_was_edited_with_the_facts_is_named(
    bags, recorded: Path, change: str
) -> None:
    before = read_bag(recorded)
    scenario = parse_yaml(before.custom_data['scenario_yaml'])
    facts = {}
    if change == 'vehicle_inertia':
        scenario['driveline'][change] += 1.0
    else:
        scenario[change] = {'control_start_s': 0.3, 'score_window_s': [0.6, 0.8]}[change]
        facts[change] = json.dumps(scenario[change])
    text = dump_yaml(scenario)
    with refused(DdctError, 'scenario_digest', place='odd.mcap') as caught:
        read_bag(edited(bags, recorded, {'scenario_yaml': text, **facts}))
    published = before.run_info['/driveline']['scenario_digest']
    assert published in str(caught.value)
    assert content_digest(scenario) in str(caught.value)


def test_a_scenario_that_was_taken_out_is_named(bags, recorded: Path) -> None:
    with refused(DdctError, 'scenario_digest', place='odd.mcap'):
        read_bag(edited(bags, recorded, {'scenario_yaml': ''}))


def test_nodes_that_published_less_contradict_nothing(bags, recorded: Path) -> None:
    def without_digest(messages):
        return [
            (topic, stamp, data.replace(b'scenario_digest', b'scenario_origin'))
            for topic, stamp, data in messages
        ]

    again = read_bag(bags.rewrite(recorded, 'earlier', without_digest, scenario_yaml=''))
    assert 'scenario_origin' in again.run_info['/driveline']


def edited(bags, recorded: Path, facts: dict[str, str]) -> Path:
    """Return the MCAP file of the bag with other facts."""
    (file,) = bags.rewrite(recorded, 'odd', **facts).glob('*.mcap')
    return file.rename(file.with_name('odd.mcap'))
