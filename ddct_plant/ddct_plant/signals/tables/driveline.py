# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics of the driveline, which owns time: they are published with every tick."""

from ddct_plant.signals.joints import Joints
from ddct_plant.signals.message_kind import Scalar
from ddct_plant.signals.signal import Signal
from ddct_plant.signals.statuses import PhaseReport
from ddct_plant.signals.tables.rows import (
    BASE_LINK,
    CLUTCH_LINK,
    JOINTS,
    if_stick_slip,
    joint_signal,
)
from ddct_plant.signals.topic import Topic

JOINT_STATES = Topic(
    'driveline/joint_states',
    Joints('sensor_msgs/msg/JointState', JOINTS),
    'driveline',
    (
        joint_signal('', 'position', JOINTS, 'rad', 'angles from 0, theta_sr of the driveshaft'),
        joint_signal('', 'speed', JOINTS, 'rad/s', 'w_m, w_p, w_r, w_sr'),
        joint_signal('', 'effort', JOINTS, 'N m', 'C_m, transmitted C_f, C_load, shaft torque'),
    ),
    BASE_LINK,
)
SLIP = Topic(
    'clutch/slip',
    Scalar('geometry_msgs/msg/TwistStamped', 'twist.angular.x'),
    'driveline',
    (Signal('slip_speed', 'rad/s', 'w_d = w_m - w_p'),),
    CLUTCH_LINK,
)
CLUTCH_PHASE = Topic(
    'clutch/phase',
    PhaseReport('diagnostic_msgs/msg/DiagnosticArray'),
    'driveline',
    (
        Signal('clutch_phase', '1', '0 open, 1 slipping, 2 locked'),
        Signal('friction_work', 'J', 'exact, of the period that has ended'),
        Signal('phase_events', '', 'what happened at slip zero in it: `PhaseEvent`'),
    ),
    when=if_stick_slip,
)
VEHICLE_SPEED = Topic(
    'vehicle/twist',
    Scalar('geometry_msgs/msg/TwistStamped', 'twist.linear.x'),
    'driveline',
    (Signal('vehicle_speed', 'm/s', 'V_x'),),
    BASE_LINK,
)
VEHICLE_ACCEL = Topic(
    'vehicle/accel',
    Scalar('geometry_msgs/msg/AccelStamped', 'accel.linear.x'),
    'driveline',
    (Signal('vehicle_accel', 'm/s^2', 'A_x'),),
    BASE_LINK,
)
