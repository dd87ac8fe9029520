# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every node checks at its start that its settings are those of the run, which its bag has."""

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from rclpy.node import Node
from support.complaints import assert_one_line
from support.in_process_graph import GraphOf, by_hand
from support.processes import Programs
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.qos import RECORDER_LATCHED_QOS
from ddct_plant.scenario.case import with_case
from ddct_plant.scenario.file import scenario_to_yaml
from ddct_plant.signals.topics import RUN_SETTINGS

CLUTCH, RECORDER = 'ddct_plant.nodes.clutch_node', 'ddct_bringup.record.recorder_node'
SHIFT = plan('pi', scenario='upshift', duration_s=1.0)


@pytest.mark.parametrize(
    ('name', 'changes', 'words'),
    [
        ('clutch', {'wear_gain': 0.5}, ['wear_gain 0.5', 'have 1.0']),
        ('engine', {'seed': 7}, ['seed 7', 'have 0']),
        ('actuator', {'mode': 'realtime'}, ['mode realtime', 'have lockstep']),
        ('load', {'scenario': 'launch'}, ['scenario.', 'launch']),
        ('reference', {'architecture': 'base'}, ['architecture base', 'have detailed']),
        ('controller', {'scenario': 'launch'}, ['scenario.', 'launch']),
        ('recorder', {'wear_gain': 0.5}, ['wear_gain 0.5', 'have 1.0']),
    ],
)
def test_a_node_that_is_given_another_value_than_the_files_of_the_run_names_both(
    graph_of: GraphOf, name: str, changes: dict[str, object], words: list[str]
) -> None:
    with pytest.raises(DdctError) as caught:
        graph_of(plan()).add(name, changes)
    assert_names(str(caught.value), f'node /{name} has', 'same settings', *words)


def test_values_that_agree_with_the_files_of_the_run_may_be_given_too(
    graph_of: GraphOf, tmp_path: Path
) -> None:
    run = plan(wear_gain=0.8)
    graph = graph_of(run)
    given = {'wear_gain': 0.8, 'mode': 'lockstep'}
    graph.add('clutch', {**given, 'scenario': scenario_file(tmp_path)})
    graph.add('controller', {'architecture': 'detailed'})
    graph.add_all()
    graph.run()
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()


@pytest.mark.parametrize(('name', 'without'), [('clutch', 'case'), ('clutch', 'known')])
def test_a_node_of_the_plant_needs_the_files_of_both_parts(
    graph_of: GraphOf, name: str, without: str
) -> None:
    graph = graph_of(plan())
    del graph.parameters['*' if without == 'known' else name][without]
    with pytest.raises(DdctError, match=f'parameter {without} is missing'):
        graph.add(name)


def test_a_file_that_is_damaged_or_of_another_version_is_named(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    file = Path(str(graph.parameters['*']['known']))
    text = file.read_text(encoding='utf-8')
    for bad, word in (
        (text.replace('"schema_version": 1', '"schema_version": 2'), 'schema_version is 2'),
        (text.replace('"mode"', '"mood"'), 'mood'),
        (text[:50], 'JSON'),
    ):
        file.write_text(bad, encoding='utf-8')
        with pytest.raises(DdctError, match=f'known.json: .*{word}'):
            graph.add('load')


@pytest.mark.parametrize(
    ('name', 'changes', 'words'),
    [
        ('clutch', {'wear_gain': 0.5}, ['wear_gain 0.5', 'have 0.8']),
        ('driveline', {'wear_gain': 1.0}, ['wear_gain 1.0', 'have 0.8']),
        ('engine', {'seed': 7}, ['seed 7', 'have 3']),
        ('engine', {'two_input': True}, ['two_input true', 'have false']),
        ('controller', {'controller': 'mpc4'}, ['two_input true', 'have false']),
        ('load', {'scenario': 'rough'}, ['scenario.load.rolling_coefficient 0.02', 'have 0.0125']),
        ('reference', {'scenario': 'rough'}, ['scenario.load.rolling_coefficient 0.02']),
        ('controller', {'architecture': 'feedforward'}, ['architecture feedforward']),
    ],
)
def test_a_node_that_is_started_by_hand_with_another_value_ends(
    graph_of: GraphOf, tmp_path: Path, name: str, changes: dict[str, Any], words: list[str]
) -> None:
    if 'scenario' in changes:
        changes = {'scenario': scenario_file(tmp_path, ['load.rolling_coefficient=0.02'])}
    graph = by_hand(
        graph_of(plan(), wall_clock=True),
        {'scenario': scenario_file(tmp_path), 'wear_gain': 0.8, 'seed': 3},
    )
    graph.add('recorder')
    graph.add(name, changes)
    node, complaint = graph.first_failure()
    assert node == name
    assert_names(complaint, f'node /{name} has', 'same settings', *words)


def test_a_node_of_the_off_going_side_compares_its_settings_too(graph_of: GraphOf) -> None:
    graph = by_hand(graph_of(SHIFT, wall_clock=True), {'scenario': 'upshift'})
    graph.add('recorder')
    graph.add('off_going/clutch', {'off_going_wear_gain': 0.9})
    node, complaint = graph.first_failure()
    assert node == 'off_going/clutch'
    words = ['off_going_wear_gain 0.9', 'have 1.0']
    assert_names(complaint, 'node /off_going/clutch has', *words)


def test_nodes_by_hand_that_agree_leave_the_bag_of_the_run_whatever_their_order(
    graph_of: GraphOf, tmp_path: Path
) -> None:
    run = plan('ls8', wear_gain=0.8, seed=3)
    settings = {'scenario': scenario_file(tmp_path), 'wear_gain': 0.8, 'seed': 3}
    graph = by_hand(graph_of(run), settings)
    for name in ('controller', 'clutch'):
        graph.add(name)
    graph.add_all()
    graph.run()
    recording = read_bag(graph.folder)
    assert recording.settings == run.settings
    assert recording.trajectory.sha256() == expected(run).sha256()


def test_nodes_by_hand_with_a_file_of_the_case_leave_the_bag_of_the_run(
    graph_of: GraphOf, tmp_path: Path
) -> None:
    file = tmp_path / 'case.yaml'
    file.write_text('vehicle: {mass_kg: 1700}\nwear_gain: 0.8\n', encoding='utf-8')
    run = plan('ls8')
    run = replace(
        run, settings=with_case(run.settings.known, {'vehicle.mass_kg': 1700, 'wear_gain': 0.8})
    )
    graph = by_hand(graph_of(run), {'scenario': scenario_file(tmp_path)})
    for name, parameters in graph.parameters.items():
        if name not in ('*', 'controller', 'reference', 'handover'):
            parameters['case'] = str(file)
    graph.add_all()
    graph.run()
    recording = read_bag(graph.folder)
    assert recording.settings == run.settings
    assert recording.trajectory.sha256() == expected(run).sha256()


def test_a_program_of_a_node_with_another_value_ends_with_one_line_and_code_1(
    programs: Programs, tmp_path: Path
) -> None:
    programs.fork(RECORDER, '--ros-args', '-p', f'out:={tmp_path / "bag"}', '-p', 'wear_gain:=0.8')
    clutch = programs.fork(CLUTCH, '--ros-args', '-p', 'wear_gain:=0.5')
    assert clutch.wait() == 1
    words = ['node /clutch has wear_gain 0.5', 'the settings of the run have 0.8']
    assert_one_line(clutch.errors(), 'clutch', *words)


@pytest.mark.parametrize('hand', [False, True])
def test_the_recorder_of_a_program_publishes_the_known_settings_alone(
    graph_of: GraphOf, hand: bool
) -> None:
    graph = graph_of(plan(wear_gain=0.8125, seed=424243))
    if hand:
        by_hand(graph, {'wear_gain': 0.8125, 'seed': 424243})
    received: list[dict[str, str]] = []
    node = Node('reader', context=graph.context)
    node.create_subscription(
        RUN_SETTINGS.message_class,
        RUN_SETTINGS.name,
        lambda message: received.append(RUN_SETTINGS.read(message)[1]),
        RECORDER_LATCHED_QOS,
    )
    graph.add_other(node)
    graph.add('recorder')
    graph.spin_until(lambda: bool(received), 'the settings')
    (pairs,) = received
    assert set(pairs) == ({'two_input', 'known', 'case'} if hand else {'two_input', 'known'})
    known = json.loads(pairs['known'])
    assert known['architecture'] == 'detailed'
    assert not {'wear_gain', 'seed'} & known.keys()
    assert ('0.8125' in str(pairs), '424243' in str(pairs)) == (hand, hand)


@pytest.mark.parametrize(
    ('path', 'role'), [('off_going/clutch', 'on_coming'), ('actuator', 'off_going')]
)
def test_a_node_whose_role_is_not_that_of_its_namespace_is_refused(
    graph_of: GraphOf, path: str, role: str
) -> None:
    with pytest.raises(DdctError, match=f'node /{path} has the role {role}, but its name is'):
        graph_of(SHIFT).add(path, {'role': role})


def scenario_file(folder: Path, changes: Sequence[str] = ()) -> str:
    """Write the scenario of `plan` with changes; return its file."""
    file = folder / f'thesis{len(changes)}.yaml'
    file.write_text(scenario_to_yaml(plan(changes=tuple(changes)).settings.scenario))
    return str(file)


def assert_names(complaint: str, *words: str) -> None:
    """Require one line with all words."""
    assert '\n' not in complaint
    for word in words:
        assert word in complaint
