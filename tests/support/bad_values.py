# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bad values on topics, and what the node that reads one must say."""

import math
from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from support.altering import add_altering, changing, remaps
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan

Spoil = Callable[[Any], None]

FROM_STEP = 30
STAMP = '1300000000 ns'


def torque(value: float) -> Spoil:
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


def two_efforts(message: JointTrajectory) -> None:
    message.points[10].effort = [1.0, 2.0]


def off_grid(message: Any) -> None:
    message.header.stamp.nanosec += 1


def time_zero(message: Any) -> None:
    message.header.stamp.sec = message.header.stamp.nanosec = 0


def skip(message: Any) -> None:
    message.header.stamp.sec += 1


CASES: dict[str, tuple[str, str, Spoil, list[str]]] = {
    'engine torque nan': ('driveline', 'engine/torque', torque(math.nan), ['nan']),
    'load torque infinite': ('driveline', 'load/torque', torque(math.inf), ['inf']),
    'clutch torque nan': ('driveline', 'clutch/torque', _point(math.nan), ['nan']),
    'clutch torque short': ('driveline', 'clutch/torque', _five_points, ['5 points']),
    'clutch torque empty': ('driveline', 'clutch/torque', _no_effort, ['effort']),
    'two efforts': ('clutch', 'actuator/torque', two_efforts, ['and no more']),
    'actuator torque': ('clutch', 'actuator/torque', _point(-math.inf), ['-inf']),
    'request nan': ('actuator', 'clutch/torque_request', torque(math.nan), ['nan']),
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
    'torque for control': ('controller', 'engine/torque', torque(math.nan), ['nan']),
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


def spoilt(graph: InProcessGraph, reader: str, topic: str, spoil: Spoil) -> InProcessGraph:
    """Spoil the messages of a topic, named as in the graph, on their way to a node."""
    graph.add(reader, cli_args=remaps(reader, [topic]))
    add_altering(graph, topic, changing(spoil, FROM_STEP), reader=reader)
    graph.add_all()
    return graph


def require_named(graph_of: GraphOf, case: str) -> None:
    """Require that a bad value ends its reader with topic and stamp."""
    reader, topic, spoil, words = CASES[case]
    node, complaint = spoilt(graph_of(plan()), reader, topic, spoil).first_failure()
    assert node == reader
    for word in (topic, STAMP, *words):
        assert word in complaint
    assert '\n' not in complaint
