# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two live publishers of one topic of the loop end the run, and both are named."""

import pytest
from support.altering import Repeating, add_altering
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_plant.signals.signal import RunKind
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    OFF_GOING_CLUTCH_TORQUE,
    SHIFT_TOPICS,
    TOPICS,
)

REPEAT_S = 0.02
"""Period in s at which a second publisher repeats the last message."""
LOOP = [topic for topic in TOPICS if topic.every_tick]
ECHOED = [topic for topic in LOOP if topic not in SHIFT_TOPICS] + [OFF_GOING_CLUTCH_TORQUE]
"""Topics of the loop of other runs, and one of a shift, where the check is the same."""
NODE_NAMES = [node.name for node in GRAPH_NODES]
COPIED = [*(name for name in NODE_NAMES if name != 'recorder'), 'handover', 'off_going/actuator']


def _graph(graph: InProcessGraph, *, recorded: bool) -> InProcessGraph:
    if not recorded:
        graph.add('driveline', {'require_recorder': False})
    graph.add_all(without=() if recorded else ['recorder'])
    return graph


@pytest.mark.parametrize('topic', ECHOED, ids=lambda topic: topic.name)
def test_a_second_publisher_of_any_loop_topic_ends_the_run_with_its_name(
    graph_of: GraphOf, topic: Topic
) -> None:
    shift = topic in SHIFT_TOPICS
    sensed = not shift and not topic.in_run(RunKind(two_input=True, clutch='stick_slip'))
    clutch = 'linear' if topic.in_run(RunKind(two_input=True, sensed=sensed)) else 'stick_slip'
    controller = 'ls8' if topic.in_run(RunKind(clutch=clutch, sensed=sensed)) else 'mpc4'
    changes = ('sensors={}',) if sensed else ()
    recorded = topic.name in ('recorder/ack', 'engine/torque')
    scenario = 'upshift' if shift else 'thesis'
    run = plan(controller, scenario=scenario, duration_s=0.3, clutch=clutch, changes=changes)
    graph = graph_of(run)
    add_altering(graph, topic.name, Repeating(REPEAT_S), name='echo')
    node, complaint = _graph(graph, recorded=recorded).first_failure()
    assert node == 'driveline', complaint
    assert complaint.startswith(f'{topic.name} has two live publishers, of the nodes /')
    assert '/echo' in complaint
    assert 'another ROS_DOMAIN_ID' in complaint


@pytest.mark.parametrize('recorded', [True, False], ids=['recorded', 'not recorded'])
@pytest.mark.parametrize('name', COPIED)
def test_a_second_copy_of_any_node_ends_the_run_with_its_name(
    graph_of: GraphOf, name: str, recorded: bool
) -> None:
    shift = name not in NODE_NAMES
    run = plan('pi', scenario='upshift', duration_s=0.3, clutch='stick_slip')
    graph = graph_of(run if shift else plan(duration_s=0.3))
    graph.add(name, key='second')
    _, complaint = _graph(graph, recorded=recorded).first_failure()
    assert 'has two live publishers, of the nodes ' in complaint
    assert f'/{name} and /{name}' in complaint
