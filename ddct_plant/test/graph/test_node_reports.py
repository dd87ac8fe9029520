# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What nodes publish about themselves is written and read in one module."""

import ast
from pathlib import Path

import pytest
from syntax import tree_of

from ddct_plant.fail_safe.request_watch import CLUTCH_TIMEOUT_S, FailSafeSettings
from ddct_plant.graph.node_reports import (
    TickCounts,
    actuator_info,
    driveline_info,
    node_info,
    safe_state_pairs,
    safe_state_since,
    timing_pairs,
    update_times,
)
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]
KEYS = {'since_ns', 'tick_lateness_us'}
OWNER = 'node_reports.py'


def test_no_other_module_spells_the_keys_of_reports() -> None:
    spelled = [
        f'{file.name}:{node.lineno}: {node.value!r}'
        for package in ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
        for file in (ROOT / package / package).rglob('*.py')
        if file.name != OWNER and any(key in file.read_text(encoding='utf-8') for key in KEYS)
        for node in ast.walk(tree_of(file))
        if isinstance(node, ast.Constant) and node.value in KEYS
    ]
    assert spelled == []


def test_counts_are_read_as_they_were_written() -> None:
    counts = TickCounts(300, 1, 2, 3)
    assert TickCounts.of(dict(counts.pairs())) == counts


def test_durations_are_read_as_they_were_written() -> None:
    samples = [0.125, 300.0, 301.0, 2e6]
    counts = TickCounts(300, 1, 2, 3, lateness_us=samples[:2], latency_us=samples)
    assert TickCounts.of(dict(counts.pairs())) == counts


@pytest.mark.parametrize('text', ['nan', '-1.0', '1.0 5:0', '1.0 inf', '1.0, 2.0'])
def test_impossible_durations_are_an_error(text: str) -> None:
    pairs = dict(TickCounts(300, 1, 2, 3).pairs()) | {'latency_us': text}
    with pytest.raises(ValueError):
        TickCounts.of(pairs)


def test_missing_replies_come_between_the_counts_and_the_lateness() -> None:
    counts = TickCounts(300, 1, 2, 3, {'load/torque': 4}, [249.6, 0.25])
    assert counts.pairs() == [
        ('steps', '300'),
        ('resends', '1'),
        ('missed_steps', '2'),
        ('late_messages', '3'),
        ('missed load/torque', '4'),
        ('tick_lateness_us', '249.600 0.250'),
    ]


@pytest.mark.parametrize('pairs', [{}, {'steps': '1'}, {'steps': 'many'}])
def test_counts_of_somebody_else_are_an_error(pairs: dict[str, str]) -> None:
    with pytest.raises((KeyError, ValueError)):
        TickCounts.of(pairs)


def test_safe_state_and_update_times_are_read_as_they_were_written() -> None:
    assert safe_state_since(dict(safe_state_pairs(1_230_000_000, 'no torque'))) == 1_230_000_000
    assert update_times(dict(timing_pairs([12.3456, 7.0]))) == [12.346, 7.0]
    assert update_times({}) == []


def test_a_headless_run_has_the_run_info_of_each_node_with_default_timeouts() -> None:
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    info = node_info(settings.known, {'controller': 'pi', 'two_input': 'true'}, 22, 350)
    assert list(info) == [
        *('engine', 'load', 'clutch', 'driveline', 'actuator', 'reference', 'controller'),
        'recorder',
    ]
    assert info['engine']['two_input'] == 'true'
    assert info['reference']['preview_steps'] == '22'
    assert driveline_info(350).items() <= info['driveline'].items()
    assert driveline_info(350) == driveline_info(350, FailSafeSettings(CLUTCH_TIMEOUT_S))
    assert actuator_info() == actuator_info(FailSafeSettings())
    assert all({'about', 'version'} <= pairs.keys() for pairs in info.values())
    assert len({pairs['about'] for pairs in info.values()}) == len(info)
