# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The settings of a run are in its bag once, as one JSON, from which everything is read."""

import json
from pathlib import Path
from typing import Any

import pytest
from refusals import refused
from support.made_bags import described, edited
from support.runs import plan, record

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.run_facts import described_run
from ddct_plant.base.errors import DdctError


@pytest.fixture(scope='module')
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the bag of a run without a graph, with a worn clutch."""
    folder = tmp_path_factory.mktemp('recorded') / 'pi'
    record(plan('pi', 'headless', wear_gain=0.8), folder)
    return folder


def test_a_bag_has_its_settings_as_one_json_beside_version_and_commit(recorded: Path) -> None:
    custom_data = read_bag(recorded).custom_data
    assert list(custom_data) == ['settings', 'version', 'commit']
    data = json.loads(custom_data['settings'])
    assert list(data) == ['schema_version', 'known', 'case']
    assert data['case'] == {
        'wear_gain': 0.8,
        'seed': 0,
        'off_going_wear_gain': None,
        'scenario': {},
    }
    assert data['known']['controller'] == 'pi'
    assert not {'wear_gain', 'seed'} & {*data['known'], *data['known']['scenario']}


def test_no_node_of_a_bag_repeats_a_setting(recorded: Path) -> None:
    recording = read_bag(recorded)
    assert recording.settings is not None
    said = {key for pairs in recording.run_info.values() for key in pairs}
    assert not said & {'scenario', 'scenario_digest', 'wear_gain', 'seed', 'architecture', 'mode'}
    assert all(pairs['about'] for pairs in recording.run_info.values())


def test_scores_follow_the_settings_alone(bags, recorded: Path) -> None:
    before = read_bag(recorded)
    changes: dict[str, Any] = {'wear_gain': 0.9, 'controller': 'ls8', 'control_start_s': 0.5}
    after = read_bag(bags.rewrite(recorded, 'odd', **changes))
    assert {name: getattr(after.facts, name) for name in changes} == changes
    assert after.settings is not None
    assert after.settings.case.wear_gain == 0.9
    assert after.trajectory.sha256() == before.trajectory.sha256()


@pytest.mark.parametrize('version', [2, 0, 1.5, None])
def test_another_schema_version_is_one_line(bags, recorded: Path, version: object) -> None:
    bag = bags.rewrite(recorded, 'odd', schema_version=version)
    with refused(DdctError, 'schema_version', place='odd_0.mcap: settings of the run'):
        read_bag(bag)


def test_a_bag_that_goes_on_after_its_planned_end_is_refused(bags, recorded: Path) -> None:
    with refused(DdctError, 'duration_s', place='odd_0.mcap'):
        read_bag(bags.rewrite(recorded, 'odd', duration_s=0.5))


@pytest.mark.parametrize(
    ('changes', 'key'),
    [
        ({'controller': '../pi'}, 'known'),
        ({'name': ''}, 'name'),
        ({'score_window_s': [0.7]}, 'score_window_s'),
        ({'control_start_s': 'late'}, 'control_start_s'),
        ({'seed': 1.5}, 'case.seed'),
        ({'wear_gain': True}, 'case.wear_gain'),
        ({'wear_gain': -1.0}, 'wear_gain'),
        ({'duration_s': 0.005}, 'known'),
        ({'duration_s': 1e9}, 'known'),
        ({'mode': 'measured'}, 'mode'),
        ({'handover': 'mine.py'}, 'known'),
        ({'handover': '../mine'}, 'known'),
        ({'nonsense': 1.0}, 'nonsense'),
        ({'scenario': None}, 'known.scenario'),
        ({'engine': 5}, 'engine'),
    ],
)
def test_a_setting_that_makes_no_run_is_named(changes: dict[str, Any], key: str) -> None:
    with refused(DdctError, key, place='settings of the run'):
        described_run(edited(described(60), **changes))


def test_text_that_is_no_json_and_a_missing_text_are_named() -> None:
    with refused(DdctError, place='settings of the run'):
        described_run({'settings': '{'})
    with refused(DdctError, 'settings'):
        described_run({'version': '1.0'})
