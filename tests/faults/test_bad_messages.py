# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A bad value on a topic ends the node that reads it, with the topic and the stamp."""

import math

import pytest
from samples import sampled
from support.bad_values import (
    STAMP,
    Spoil,
    off_grid,
    require_named,
    skip,
    spoilt,
    time_zero,
    torque,
    two_efforts,
)
from support.in_process_graph import GraphOf
from support.runs import plan

SAMPLE = (
    *('engine torque nan', 'clutch torque short', 'two efforts', 'request nan'),
    *('speed for the load', 'slip nan', 'joint order', 'no velocity', 'reference nan'),
    *('other joint', 'no preview'),
)
"""Cases of the readers and of the kinds of a bad message; tests/nightly has all."""


@pytest.mark.parametrize('case', sampled(SAMPLE, every=2))
def test_a_bad_value_ends_its_reader_with_topic_and_stamp(graph_of: GraphOf, case: str) -> None:
    require_named(graph_of, case)


@pytest.mark.parametrize(
    ('spoil', 'words'),
    [
        (off_grid, ['1300000001 ns', 'not on the grid']),
        (time_zero, ['stamp 0 ns', 'not on the grid']),
        (skip, ['step 130', 'step 30', 'missed a part of the run']),
    ],
    ids=['off the grid', 'time zero', 'skipped'],
)
def test_a_bad_stamp_ends_a_follower_with_its_topic(
    graph_of: GraphOf, spoil: Spoil, words: list[str]
) -> None:
    graph = graph_of(plan())
    spoilt(graph, 'clutch', 'actuator/torque', spoil)
    node, complaint = graph.first_failure()
    assert node == 'clutch'
    for word in ('actuator/torque', *words):
        assert word in complaint


@pytest.mark.parametrize(
    ('reader', 'topic', 'spoil'),
    sampled(
        [
            ('off_going/clutch', 'actuator/torque', two_efforts),
            ('off_going/clutch', 'actuator/torque', off_grid),
            ('off_going/actuator', 'clutch/torque_request', torque(-math.inf)),
            ('off_going/actuator', 'clutch/torque_request', skip),
        ],
        every=3,
    ),
)
def test_a_node_of_the_off_going_side_names_its_topic_as_the_graph_does(
    graph_of: GraphOf, reader: str, topic: str, spoil: Spoil
) -> None:
    graph = graph_of(plan('pi', scenario='upshift'))
    spoilt(graph, reader, f'off_going/{topic}', spoil)
    node, complaint = graph.first_failure()
    assert node == reader
    assert f'off_going/{topic}' in complaint


def test_the_driveline_waits_in_vain_for_the_right_stamp(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    graph.parameters['driveline']['answer_timeout_s'] = 0.5
    spoilt(graph, 'driveline', 'load/torque', off_grid)
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert complaint.startswith(f'no load/torque for stamp {STAMP} (step 30) within 0.5 s')


def test_a_bad_stamp_ends_the_recorder_with_its_topic(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    spoilt(graph, 'recorder', 'clutch/slip', off_grid)
    node, complaint = graph.first_failure()
    assert node == 'recorder'
    assert complaint.startswith('clutch/slip: stamp 1300000001 ns is not on the grid')
