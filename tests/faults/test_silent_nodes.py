# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node that is missing, hangs or starts late: the driveline names what it waits for."""

import pytest
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan

from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.signals.topics import LOAD_TORQUE

LOAD = LOAD_TORQUE.name


def _graph(graph: InProcessGraph, timeout_s: float = 1.0) -> InProcessGraph:
    graph.parameters['driveline']['answer_timeout_s'] = timeout_s
    return graph


def _step(graph: InProcessGraph) -> int:
    return graph.driveline.owner.step


@pytest.mark.parametrize(
    ('absent', 'words'),
    [
        ('engine', 'no engine/torque and no clutch/torque and no recorder/ack'),
        ('load', 'no load/torque and no recorder/ack'),
        ('clutch', 'no clutch/torque and no recorder/ack'),
        ('reference', 'no clutch/torque and no recorder/ack'),
        ('controller', 'no clutch/torque and no recorder/ack'),
        ('recorder', 'no recorder/ack'),
    ],
)
def test_a_node_that_never_starts_leaves_its_topic_missing(
    graph_of: GraphOf, absent: str, words: str
) -> None:
    graph = _graph(graph_of(plan()))
    graph.add_all(without=[absent])
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert complaint.startswith(f'{words} for stamp 1000000000 ns (step 0) within 1 s: ')


def test_a_node_that_stops_publishing_ends_the_run_at_its_step(graph_of: GraphOf) -> None:
    graph = _graph(graph_of(plan()))
    graph.add_all()
    graph.spin_until(lambda: _step(graph) >= 20, 'step 20')
    assert _step(graph) == 20
    graph.remove('load')
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert _step(graph) == 20
    assert f'no load/torque and no recorder/ack for stamp {10**9 + 20 * 10**7} ns' in complaint


@pytest.mark.parametrize('late', ['clutch', 'controller'])
def test_a_follower_that_is_started_in_the_middle_ends_with_the_reason(
    graph_of: GraphOf, late: str
) -> None:
    graph = _graph(graph_of(plan()), timeout_s=20.0)
    graph.add_all()
    graph.spin_until(lambda: _step(graph) >= 20, 'step 20')
    graph.remove(late)
    resends = graph.driveline.owner.resends
    # By then no reply of the removed node is under way, and the step stands still.
    graph.spin_until(lambda: graph.driveline.owner.resends >= resends + 2, 'a tick sent again')
    graph.add(late)
    node, complaint = graph.first_failure()
    assert node == late
    assert f'step {_step(graph)} came where step 0 was due' in complaint
    assert 'start the graph again' in complaint


def test_a_recorder_that_is_started_in_the_middle_ends_with_the_reason(graph_of: GraphOf) -> None:
    graph = _graph(graph_of(plan(duration_s=600.0)))
    graph.add('driveline', {'require_recorder': False})
    graph.add_all(without=['recorder'])
    graph.spin_until(lambda: _step(graph) >= 20, 'step 20')
    graph.add_all()
    node, complaint = graph.first_failure()
    assert node == 'recorder'
    assert 'came where step 0 was due' in complaint
    assert 'require_recorder' in complaint
    assert not list(graph.folder.glob('*.mcap'))


def test_real_time_gives_up_on_a_torque_that_stays_away(graph_of: GraphOf) -> None:
    graph = _graph(graph_of(plan(mode='realtime', duration_s=600.0)))
    graph.add_all()
    owner = graph.driveline.owner
    graph.spin_until(lambda: owner.step >= 20 and LOAD not in owner.missing(), 'step 20')
    last = owner.step
    graph.remove('load')
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert complaint == (
        f'no load/torque since stamp {stamp_of_step(last)} ns, 1.01 s ago: check that the node '
        'which publishes it is running'
    )
