# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A bad value on a topic ends the node that reads it, with the topic and the stamp."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from geometry_msgs.msg import TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState
from support.altering import add_altering, changing, remaps
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan
from trajectory_msgs.msg import JointTrajectory

Spoil = Callable[[Any], None]

FROM_STEP = 30
STAMP = '1300000000 ns'


def _torque(value: float) -> Spoil:
    def spoil(message: WrenchStamped) -> None:
        message.wrench.torque.x = value

    return spoil


def _point(value: float) -> Spoil:
    def spoil(message: JointTrajectory) -> None:
        message.points[7].effort[0] = value

    return spoil


def _slip(message: TwistStamped) -> None:
    message.twist.angular.x = math.nan


def _vehicle_speed(message: TwistStamped) -> None:
    message.twist.linear.x = -math.inf


def _joint_speed(message: JointState) -> None:
    message.velocity[1] = math.nan


def _joint_order(message: JointState) -> None:
    message.name = list(reversed(message.name))


def _no_velocity(message: JointState) -> None:
    message.velocity = []


def _long_effort(message: JointState) -> None:
    message.effort = [0.0] * 1000


def _reference(message: JointTrajectory) -> None:
    message.points[0].velocities[0] = math.nan


def _other_joint(message: JointTrajectory) -> None:
    message.joint_names = ['wheel']


def _no_reference(message: JointTrajectory) -> None:
    message.points = []


def _no_rate(message: JointTrajectory) -> None:
    message.points[0].accelerations = []


def _five_points(message: JointTrajectory) -> None:
    message.points = message.points[:5]


def _no_effort(message: JointTrajectory) -> None:
    message.points[10].effort = []


def _two_efforts(message: JointTrajectory) -> None:
    message.points[10].effort = [1.0, 2.0]


def _off_grid(message: Any) -> None:
    message.header.stamp.nanosec += 1


def _time_zero(message: Any) -> None:
    message.header.stamp.sec = message.header.stamp.nanosec = 0


def _skip(message: Any) -> None:
    message.header.stamp.sec += 1


CASES: dict[str, tuple[str, str, Spoil, list[str]]] = {
    'engine torque nan': ('driveline', 'engine/torque', _torque(math.nan), ['nan']),
    'load torque infinite': ('driveline', 'load/torque', _torque(math.inf), ['inf']),
    'clutch torque nan': ('driveline', 'clutch/torque', _point(math.nan), ['nan']),
    'clutch torque short': ('driveline', 'clutch/torque', _five_points, ['5 points']),
    'clutch torque empty': ('driveline', 'clutch/torque', _no_effort, ['effort']),
    'two efforts': ('clutch', 'actuator/torque', _two_efforts, ['and no more']),
    'actuator torque': ('clutch', 'actuator/torque', _point(-math.inf), ['-inf']),
    'request nan': ('actuator', 'clutch/torque_request', _torque(math.nan), ['nan']),
    'speed for the load': ('load', 'vehicle/twist', _vehicle_speed, ['-inf']),
    'slip nan': ('reference', 'clutch/slip', _slip, ['nan']),
    'speed nan': ('controller', 'driveline/joint_states', _joint_speed, ['nan']),
    'joint order': ('controller', 'driveline/joint_states', _joint_order, ['order']),
    'no velocity': ('controller', 'driveline/joint_states', _no_velocity, ['0 vel']),
    'long effort': (
        'controller',
        'driveline/joint_states',
        _long_effort,
        ['1000 numbers in effort'],
    ),
    'speed for control': ('controller', 'vehicle/twist', _vehicle_speed, ['-inf']),
    'torque for control': ('controller', 'engine/torque', _torque(math.nan), ['nan']),
    'reference nan': ('controller', 'clutch/slip_reference', _reference, ['nan']),
    'other joint': ('controller', 'clutch/slip_reference', _other_joint, ['wheel']),
    'no rate': ('controller', 'clutch/slip_reference', _no_rate, ['acceleration']),
    'no preview': (
        'controller',
        'clutch/slip_reference',
        _no_reference,
        ['0 points', 'preview_steps:=0'],
    ),
}


def _spoilt(graph: InProcessGraph, reader: str, topic: str, spoil: Spoil) -> InProcessGraph:
    """Spoil the messages of a topic, named as in the graph, on their way to a node."""
    graph.add(reader, cli_args=remaps(reader, [topic]))
    add_altering(graph, topic, changing(spoil, FROM_STEP), reader=reader)
    graph.add_all()
    return graph


@pytest.mark.parametrize(('reader', 'topic', 'spoil', 'words'), CASES.values(), ids=CASES)
def test_a_bad_value_ends_its_reader_with_topic_and_stamp(
    graph_of: GraphOf, reader: str, topic: str, spoil: Spoil, words: list[str]
) -> None:
    graph = _spoilt(graph_of(plan()), reader, topic, spoil)
    node, complaint = graph.first_failure()
    assert node == reader
    for word in (topic, STAMP, *words):
        assert word in complaint
    assert '\n' not in complaint


@pytest.mark.parametrize(
    ('spoil', 'words'),
    [
        (_off_grid, ['1300000001 ns', 'not on the grid']),
        (_time_zero, ['stamp 0 ns', 'not on the grid']),
        (_skip, ['step 130', 'step 30', 'missed a part of the run']),
    ],
    ids=['off the grid', 'time zero', 'skipped'],
)
def test_a_bad_stamp_ends_a_follower_with_its_topic(
    graph_of: GraphOf, spoil: Spoil, words: list[str]
) -> None:
    graph = graph_of(plan())
    _spoilt(graph, 'clutch', 'actuator/torque', spoil)
    node, complaint = graph.first_failure()
    assert node == 'clutch'
    for word in ('actuator/torque', *words):
        assert word in complaint


@pytest.mark.parametrize(
    ('reader', 'topic', 'spoil'),
    [
        ('off_going/clutch', 'actuator/torque', _two_efforts),
        ('off_going/clutch', 'actuator/torque', _off_grid),
        ('off_going/actuator', 'clutch/torque_request', _torque(-math.inf)),
        ('off_going/actuator', 'clutch/torque_request', _skip),
    ],
)
def test_a_node_of_the_off_going_side_names_its_topic_as_the_graph_does(
    graph_of: GraphOf, reader: str, topic: str, spoil: Spoil
) -> None:
    graph = graph_of(plan('pi', scenario='upshift', clutch='stick_slip'))
    _spoilt(graph, reader, f'off_going/{topic}', spoil)
    node, complaint = graph.first_failure()
    assert node == reader
    assert f'off_going/{topic}' in complaint


def test_the_driveline_waits_in_vain_for_the_right_stamp(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    graph.parameters['driveline']['answer_timeout_s'] = 0.5
    _spoilt(graph, 'driveline', 'load/torque', _off_grid)
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert complaint.startswith(f'no load/torque for stamp {STAMP} (step 30) within 0.5 s')


def test_a_bad_stamp_ends_the_recorder_with_its_topic(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    _spoilt(graph, 'recorder', 'clutch/slip', _off_grid)
    node, complaint = graph.first_failure()
    assert node == 'recorder'
    assert complaint.startswith('clutch/slip: stamp 1300000001 ns is not on the grid')
