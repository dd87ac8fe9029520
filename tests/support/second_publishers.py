# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Second publishers of a topic of the loop, and what the driveline says of them."""

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import SHIFT_TOPICS, TOPICS
from support.altering import Repeating, add_altering
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan

REPEAT_S = 0.02
"""Period in s at which a second publisher repeats the last message."""
LOOP = [topic for topic in TOPICS if topic.every_tick]
NODE_NAMES = [node.name for node in GRAPH_NODES]


def require_named_echo(graph_of: GraphOf, topic: Topic) -> None:
    """Require that a second publisher of a topic ends a run that has it, and is named."""
    shift = topic in SHIFT_TOPICS
    sensed = not shift and not topic.in_run(RunKind(two_input=True, clutch='stick_slip'))
    clutch = 'linear' if topic.in_run(RunKind(two_input=True, sensed=sensed)) else 'stick_slip'
    controller = 'ls8' if topic.in_run(RunKind(clutch=clutch, sensed=sensed)) else 'mpc4'
    changes = ('sensors={}',) if sensed else ()
    recorded = topic.name in ('recorder/ack', 'engine/torque')
    of_clutch = 'thesis' if clutch == 'linear' else 'thesis_sticking'
    scenario = 'upshift' if shift else of_clutch
    run = plan(controller, scenario=scenario, duration_s=0.3, changes=changes)
    graph = graph_of(run)
    add_altering(graph, topic.name, Repeating(REPEAT_S), name='echo')
    node, complaint = _complete(graph, recorded=recorded).first_failure()
    assert node == 'driveline', complaint
    assert complaint.startswith(f'{topic.name} has two live publishers, of the nodes /')
    assert '/echo' in complaint
    assert 'another ROS_DOMAIN_ID' in complaint


def require_named_copy(graph_of: GraphOf, name: str, *, recorded: bool) -> None:
    """Require that a second copy of a node ends a run that has it, and that both are named."""
    shift = name not in NODE_NAMES
    run = plan('pi', scenario='upshift', duration_s=0.3)
    graph = graph_of(run if shift else plan(duration_s=0.3))
    graph.add(name, key='second')
    _, complaint = _complete(graph, recorded=recorded).first_failure()
    assert 'has two live publishers, of the nodes ' in complaint
    assert f'/{name} and /{name}' in complaint


def _complete(graph: InProcessGraph, *, recorded: bool) -> InProcessGraph:
    """Add the nodes that are missing, the recorder only if the run is recorded."""
    if not recorded:
        graph.add('driveline', {'require_recorder': False})
    graph.add_all(without=() if recorded else ['recorder'])
    return graph
