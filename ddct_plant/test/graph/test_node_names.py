# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes are identified by full names, relative to the namespace of their graph."""

import pytest

from ddct_plant.graph.node_names import StatusName, name_in_graph, topic_in_graph


@pytest.mark.parametrize(
    ('node', 'namespace', 'expected'),
    [
        ('/engine', '/', '/engine'),
        ('engine', '/', '/engine'),
        ('engine', '/car7', '/engine'),
        ('/car7/engine', '/car7', '/engine'),
        ('/car7/off_going/actuator', '/car7', '/off_going/actuator'),
        ('/car70/engine', '/car7', '/car70/engine'),
        ('/car8/engine', '/car7', '/car8/engine'),
        ('/engine', '/car7', '/engine'),
    ],
)
def test_a_name_is_relative_to_the_namespace_of_its_graph(node, namespace, expected):
    assert name_in_graph(node, namespace) == expected


@pytest.mark.parametrize(
    ('topic', 'namespace', 'expected'),
    [
        ('clutch/torque', '/', 'clutch/torque'),
        ('clutch/torque', '/car7/powertrain', 'clutch/torque'),
        ('clutch/torque', '/off_going', 'off_going/clutch/torque'),
        ('clutch/torque', '/car7/off_going', 'off_going/clutch/torque'),
        ('clutch/torque', '/not_off_going', 'clutch/torque'),
        ('/clock', '/off_going', '/clock'),
    ],
)
def test_a_topic_is_relative_to_the_namespace_of_the_graph_of_its_node(topic, namespace, expected):
    assert topic_in_graph(topic, namespace) == expected


def test_the_name_of_a_status_is_its_node_and_what_it_describes():
    name = StatusName.of('/car7/driveline: ticks', '/car7')
    assert (name, str(name)) == (('/driveline', ': ticks'), '/driveline: ticks')
    assert StatusName.of('driveline: ticks') == StatusName('/driveline', ': ticks')
    assert StatusName.of('temperature') == StatusName('', 'temperature')
    assert StatusName.of('/driveline: ticks', '/car7').node == '', 'of a graph without namespace'
