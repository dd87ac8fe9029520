# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Of the QoS only the depth can be overridden, and a deeper queue changes no byte of a bag."""

from typing import Any

import pytest
from refusals import refused
from support.in_process_graph import GraphOf
from support.runs import bag_bytes, plan

from ddct_plant.base.errors import ParameterError
from ddct_plant.graph.arguments import require_declared
from ddct_plant.graph.qos import LATCHED_QOS, LOOP_QOS

PUBLISHER = 'qos_overrides./clutch/torque.publisher'
SUBSCRIPTION = 'qos_overrides./actuator/torque.subscription'


def depths(node: Any) -> dict[str, int]:
    """Return the depth of each publisher and subscription of the graph's topics, by parameter."""
    ends = [('publisher', each) for each in node.publishers]
    ends += [('subscription', each) for each in node.subscriptions]
    declared = {f'qos_overrides.{each.topic_name}.{kind}.depth': each for kind, each in ends}
    return {
        name: each.qos_profile.depth for name, each in declared.items() if node.has_parameter(name)
    }


def test_each_endpoint_of_a_node_declares_its_depth(graph_of: GraphOf) -> None:
    node = graph_of(plan()).add('clutch', {f'{PUBLISHER}.depth': 50})
    assert depths(node) == {
        'qos_overrides./run_info.publisher.depth': 1,
        'qos_overrides./clutch/torque.publisher.depth': 50,
        'qos_overrides./actuator/torque.subscription.depth': 10,
    }
    require_declared(node)
    assert [name for name in node.own_parameters() if 'qos' in name] == []
    assert (LOOP_QOS.depth, LATCHED_QOS.depth) == (10, 1), 'the profiles of other nodes stay'


@pytest.mark.parametrize(
    'policy',
    ['reliability', 'deadline'],
)
@pytest.mark.parametrize('endpoint', [PUBLISHER, SUBSCRIPTION])
def test_no_other_policy_can_be_overridden(graph_of: GraphOf, endpoint: str, policy: str) -> None:
    node = graph_of(plan()).add('clutch', {f'{endpoint}.{policy}': 'best_effort'})
    with refused(ParameterError, f'{endpoint}.{policy}'):
        require_declared(node)


@pytest.mark.parametrize('depth', [9, 'deep'])
@pytest.mark.parametrize('endpoint', [PUBLISHER, SUBSCRIPTION])
def test_a_smaller_depth_or_none_is_refused(
    graph_of: GraphOf, endpoint: str, depth: object
) -> None:
    topic = endpoint.split('.')[1].removeprefix('/')
    with refused(ParameterError, topic):
        graph_of(plan()).add('clutch', {f'{endpoint}.depth': depth})


def test_an_override_for_a_topic_of_another_node_is_refused(graph_of: GraphOf) -> None:
    node = graph_of(plan()).add('clutch', {'qos_overrides./load/torque.publisher.depth': 20})
    with refused(ParameterError, 'qos_overrides./load/torque.publisher.depth'):
        require_declared(node)


def test_deeper_queues_leave_the_same_bytes(graph_of: GraphOf) -> None:
    bags = []
    for deeper in ({}, {f'{PUBLISHER}.depth': 64, f'{SUBSCRIPTION}.depth': 64}):
        graph = graph_of(plan())
        graph.add('clutch', deeper)
        graph.add_all()
        graph.run()
        bags.append(bag_bytes(graph.folder))
    assert bags[0] == bags[1]
