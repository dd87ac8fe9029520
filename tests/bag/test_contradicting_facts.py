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


def edited(bags, recorded: Path, facts: dict[str, str]) -> Path:
    """Return the MCAP file of the bag with other facts."""
    (file,) = bags.rewrite(recorded, 'odd', **facts).glob('*.mcap')
    return file.rename(file.with_name('odd.mcap'))
