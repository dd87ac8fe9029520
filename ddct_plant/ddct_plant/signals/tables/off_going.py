# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics of a gear shift alone: those of the handover and of the off-going side."""

from ddct_plant.signals.handover_share import ShareVector
from ddct_plant.signals.joints import OneShaft
from ddct_plant.signals.message_kind import Scalar
from ddct_plant.signals.signal import Signal
from ddct_plant.signals.statuses import FRICTION_WORK, TIE_UP_WORK, PhaseReport
from ddct_plant.signals.tables.clutch import ACTUATOR_TORQUE, CLUTCH_TEMPERATURE, CLUTCH_TORQUE
from ddct_plant.signals.tables.driveline import CLUTCH_PHASE, SLIP
from ddct_plant.signals.tables.rows import (
    BASE_LINK,
    CLUTCH_LINK,
    ENGINE_LINK,
    if_shift,
    status_topic,
    torque_row,
    torque_topic,
)
from ddct_plant.signals.topic import Topic

OFF_GOING_RUN_SETTINGS = status_topic(
    'off_going/run_settings', 'recorder', every_tick=False, latched=True, when=if_shift
)
"""As `run_settings`, for the nodes of the off-going side; in no recording."""
OFF_GOING_RUN_INFO = status_topic(
    'off_going/run_info', 'every node of off_going', every_tick=False, latched=True, when=if_shift
)
OFF_GOING_JOINT_STATES = Topic(
    'off_going/joint_states',
    OneShaft('sensor_msgs/msg/JointState', 'primary_shaft'),
    'driveline',
    (
        Signal('off_going_shaft_angle', 'rad', 'angle of the off-going primary shaft from 0'),
        Signal('off_going_shaft_speed', 'rad/s', 'w_p1, speed of the off-going primary shaft'),
        Signal('off_going_transmitted_torque', 'N m', 'C_1, transmitted by the off-going clutch'),
    ),
    BASE_LINK,
    when=if_shift,
)
OFF_GOING_SLIP = Topic(
    'off_going/clutch/slip',
    SLIP.kind,
    'driveline',
    (Signal('off_going_slip_speed', 'rad/s', 'w_m - w_p1'),),
    CLUTCH_LINK,
    when=if_shift,
)
OFF_GOING_PHASE = Topic(
    'off_going/clutch/phase',
    PhaseReport(CLUTCH_PHASE.type, (FRICTION_WORK, TIE_UP_WORK)),
    'driveline',
    (
        Signal('off_going_clutch_phase', '1', '0 open, 1 slipping, 2 locked'),
        Signal('off_going_friction_work', 'J', 'exact, of the period that has ended'),
        Signal('tie_up_work', 'J', 'exact, of both clutches against each other in it'),
        Signal('off_going_phase_events', '', 'what happened at slip zero in it: `PhaseEvent`'),
    ),
    when=if_shift,
)
HANDOVER_SHARE = Topic(
    'clutch/handover_share',
    ShareVector('geometry_msgs/msg/Vector3Stamped'),
    'handover',
    (
        Signal('handover_share', '1', 'of C_fOL, which the on-coming clutch carries; 1: feedback'),
        Signal('on_coming_wear_deviation', '1', 'estimate of its wear gain less 1'),
        Signal('on_coming_torque_offset', 'N m', 'estimate of what it carries beyond that gain'),
    ),
    CLUTCH_LINK,
    when=if_shift,
)
OFF_GOING_TORQUE_REQUEST = torque_topic(
    'off_going/clutch/torque_request',
    'handover',
    CLUTCH_LINK,
    'off_going_torque_request',
    'before saturation',
    when=if_shift,
)
TORQUE_CUT = Topic(
    'engine/torque_cut',
    Scalar('geometry_msgs/msg/WrenchStamped', 'wrench.torque.x', at_least=0.0),
    'handover',
    (Signal('torque_cut', 'N m', "taken off the driver's demand"),),
    ENGINE_LINK,
    when=if_shift,
)
OFF_GOING_ACTUATOR_TORQUE = Topic(
    'off_going/actuator/torque',
    ACTUATOR_TORQUE.kind,
    'off_going/actuator',
    (torque_row('off_going_actuator_torque', 'torque of the off-going actuator'),),
    CLUTCH_LINK,
    when=if_shift,
)
OFF_GOING_CLUTCH_TORQUE = Topic(
    'off_going/clutch/torque',
    CLUTCH_TORQUE.kind,
    'off_going/clutch',
    (
        torque_row('off_going_clutch_torque', 'capacity of the off-going clutch while it slips'),
        torque_row('off_going_clutch_static_torque', 'capacity while it sticks'),
    ),
    CLUTCH_LINK,
    when=if_shift,
)
OFF_GOING_CLUTCH_TEMPERATURE = Topic(
    'off_going/clutch/temperature',
    CLUTCH_TEMPERATURE.kind,
    'off_going/clutch',
    (Signal('off_going_clutch_temperature', 'degC', 'of the facing of the off-going clutch'),),
    CLUTCH_LINK,
    when=if_shift,
)
