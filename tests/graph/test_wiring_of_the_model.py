# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The model of the protocols has the wiring of the graph: who waits for which topics."""

from typing import Any, NamedTuple

import pytest
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan
from tick_network import ACK, DRIVELINE, ONE_CLUTCH, RECORDER, TWO_CLUTCHES, Wires, Wiring

from ddct_bringup.run.plan import RunPlan
from ddct_plant.graph.follower import FollowerNode
from ddct_plant.signals.topics import recorded_topics

TOPICS = {
    'joints': 'driveline/joint_states',
    'slip': 'clutch/slip',
    'twist': 'vehicle/twist',
    'phase': 'clutch/phase',
    'off/slip': 'off_going/clutch/slip',
    'off/phase': 'off_going/clutch/phase',
    'demand': 'engine/torque_demand',
    'cut': 'engine/torque_cut',
    'share': 'clutch/handover_share',
    'reference': 'clutch/slip_reference',
    'request': 'clutch/torque_request',
    'holding': 'load/holding_torque',
    'off/request': 'off_going/clutch/torque_request',
    'off/actuator/torque': 'off_going/actuator/torque',
    'off/torque': 'off_going/clutch/torque',
}
"""Names in the graph of what the model names in another way."""
NODES = {'off/actuator': 'off_going/actuator', 'off/clutch': 'off_going/clutch'}
RUNS = {
    'one clutch': (plan(layout='single-process'), ONE_CLUTCH),
    'two clutches': (
        plan('pi', 'single-process', scenario='upshift'),
        TWO_CLUTCHES,
    ),
}


class Built(NamedTuple):
    """Every node of a run, which does not begin, and the wiring of the model."""

    run: RunPlan
    graph: InProcessGraph
    wiring: Wiring


@pytest.fixture(params=list(RUNS))
def built(graph_of: GraphOf, request: pytest.FixtureRequest) -> Built:
    run, wiring = RUNS[request.param]
    graph = graph_of(run)
    graph.add_all()
    return Built(run, graph, wiring)


def in_graph(topics: Any) -> list[str]:
    return [f'/{TOPICS.get(topic, topic)}' for topic in topics]


def every_tick(run: RunPlan, endpoints: Any) -> set[str]:
    """Return the topics of subscriptions or publishers with a message at each tick of a run."""
    kind = run.settings.kind(two_input=False)
    names = {topic.resolved_name for topic in recorded_topics(kind) if topic.every_tick}
    return {endpoint.topic_name for endpoint in endpoints} & names


def as_nodes(wiring: Wiring) -> dict[str, Wires]:
    """Return the nodes of the model by their names in the graph, with one engine."""
    nodes = {NODES.get(name, name): wires for name, wires in wiring.nodes.items()}
    if (demand := nodes.pop('demand', None)) is not None:
        engine = nodes['engine']
        assert demand.inputs == engine.inputs[:1]
        nodes['engine'] = Wires(engine.inputs, engine.outputs + demand.outputs)
    return nodes


def test_each_node_joins_the_topics_of_the_model_with_the_same_trigger(built: Built) -> None:
    run, graph, wiring = built
    joined = {}
    for path, node in graph.nodes.items():
        if isinstance(node, FollowerNode):
            names = [node.resolve_topic_name(topic) for topic in node.join.topics]
            assert set(names) == every_tick(run, node.subscriptions), path
            joined[path] = names
    expected = {path: in_graph(wires.inputs) for path, wires in as_nodes(wiring).items()}
    assert {path: (names[0], set(names)) for path, names in joined.items()} == {
        path: (names[0], set(names)) for path, names in expected.items()
    }


def test_each_node_answers_with_the_topics_of_the_model_that_another_one_waits_for(
    built: Built,
) -> None:
    run, graph, wiring = built
    nodes = graph.nodes
    awaited: set[str] = set().union(
        *(every_tick(run, node.subscriptions) for path, node in nodes.items() if path != RECORDER)
    )
    answers = {path: every_tick(run, node.publishers) & awaited for path, node in nodes.items()}
    expected = {path: set(in_graph(wires.outputs)) for path, wires in as_nodes(wiring).items()}
    expected |= {DRIVELINE: set(in_graph(wiring.ticks)), RECORDER: set(in_graph([ACK]))}
    assert answers == expected


def test_driveline_and_recorder_wait_for_the_topics_of_the_model(built: Built) -> None:
    run, graph, wiring = built
    plan_of_ticks = graph.driveline.plan
    assert [f'/{topic}' for topic in plan_of_ticks.torques] == in_graph(wiring.torques)
    assert [f'/{topic}' for topic in plan_of_ticks.clutches] == in_graph(wiring.clutches)
    awaited = every_tick(run, graph.driveline.subscriptions)
    assert awaited == set(in_graph((*wiring.torques, ACK)))
    recorded = every_tick(run, graph.nodes[RECORDER].subscriptions)
    assert set(in_graph(wiring.with_recorder().nodes[RECORDER].inputs)) <= recorded
