# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics of the reference and of the controller."""

from ddct_plant.signals.joints import NamedTorques
from ddct_plant.signals.points import PreviewPoints
from ddct_plant.signals.signal import Signal
from ddct_plant.signals.tables.rows import (
    CLUTCH_LINK,
    ENGINE_LINK,
    TRAJECTORY,
    if_two_input,
    status_topic,
    torque_topic,
)
from ddct_plant.signals.topic import Topic

SLIP_REFERENCE = Topic(
    'clutch/slip_reference',
    PreviewPoints(TRAJECTORY, ('clutch_slip',)),
    'reference',
    (
        Signal('slip_reference', 'rad/s', 'value i is i x 10 ms ahead', None),
        Signal('slip_reference_rate', 'rad/s^2', 'each over the period that follows', None),
    ),
    CLUTCH_LINK,
)
CONTROLLER_STATUS = status_topic(
    'controller/status',
    'controller',
    status_name='controller',
    signals=(Signal('status', '', 'the (key, value) pairs'),),
)
TORQUE_REQUEST = torque_topic(
    'clutch/torque_request', 'controller', CLUTCH_LINK, 'torque_request', 'before saturation'
)
TORQUE_PARTS = Topic(
    'controller/torque_parts',
    NamedTorques('sensor_msgs/msg/JointState', ('open_loop', 'closed_loop', 'closing')),
    'controller',
    (
        Signal('open_loop_torque', 'N m', 'part of the request without feedback'),
        Signal('closed_loop_torque', 'N m', 'part of the request that feedback gives'),
        Signal('closing_torque', 'N m', 'share of the closing stage in open_loop_torque'),
    ),
    CLUTCH_LINK,
    optional=True,
)
ENGINE_REQUEST = torque_topic(
    'engine/torque_request',
    'controller',
    ENGINE_LINK,
    'engine_torque_request',
    'requested of the engine',
    when=if_two_input,
)
