# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Common parts of the tables of topics: names of joints, frames, conditions, kinds of rows."""

from typing import Any

from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.models.driveline import JointValues, SensedJoints
from ddct_plant.signals.message_kind import Scalar
from ddct_plant.signals.signal import RunKind, Signal
from ddct_plant.signals.statuses import Status
from ddct_plant.signals.topic import Topic

JOINTS = JointValues._fields
"""Names of the joints in `driveline/joint_states`, in their order."""
SENSED_JOINTS = SensedJoints._fields
"""Joints whose speed a sensor measures."""
BASE_LINK = 'base_link'
"""Frame of the car's body (REP-105), x forward: of its motion, and of what joints carry."""
ENGINE_LINK, CLUTCH_LINK, WHEEL_LINK = 'engine_link', 'clutch_link', 'wheel_link'
"""Frames whose x axis is the axis on which crankshaft, clutch and wheels turn."""
TRAJECTORY = 'trajectory_msgs/msg/JointTrajectory'
"""Message type of torques within a period and of previews."""


def if_two_input(run: RunKind) -> bool:
    """Return whether the controller of a run also commands the engine."""
    return run.two_input


def if_stick_slip(run: RunKind) -> bool:
    """Return whether the clutch of a run sticks and slips."""
    return run.clutch == STICK_SLIP


def if_sensed(run: RunKind) -> bool:
    """Return whether a run has sensors."""
    return run.sensed


def if_shift(run: RunKind) -> bool:
    """Return whether a run is a gear shift."""
    return run.shift


def torque_topic(
    name: str, publisher: str, frame: str, signal: str, about: str, **options: Any
) -> Topic:
    """Return the topic of one torque in N m."""
    kind = Scalar('geometry_msgs/msg/WrenchStamped', 'wrench.torque.x')
    return Topic(name, kind, publisher, (Signal(signal, 'N m', about),), frame, **options)


def status_topic(name: str, publisher: str, **options: Any) -> Topic:
    """Return a topic with the (key, value) pairs of a status called `status_name`."""
    kind = Status('diagnostic_msgs/msg/DiagnosticArray', options.pop('status_name', ''))
    return Topic(name, kind, publisher, **options)


def joint_signal(
    prefix: str, quantity: str, joints: tuple[str, ...], unit: str, about: str
) -> Signal:
    """Return the signal with one value per joint, each named after its joint and the quantity."""
    parts = tuple(f'{prefix}{joint}_{quantity}' for joint in joints)
    return Signal(f'{prefix}joint_{quantity}', unit, about, len(joints), parts)


def torque_row(name: str, about: str, **options: Any) -> Signal:
    """Return the signal of a torque within a period."""
    return Signal(name, 'N m', f'{about}, at 0, 1, ..., 10 ms after t_k', SUBSTEPS + 1, **options)
