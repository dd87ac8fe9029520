# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The one table of topics, in the order in which a tick is written; independent of ROS.

Nodes, recorder, reader, trajectory, the tables of signals and the live view use its names, types,
values and units. A new topic is one entry below, and the node that publishes it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from operator import itemgetter
from typing import Any

from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.models.clutch import STICK_SLIP
from ddct_plant.models.driveline import JointValues, SensedJoints
from ddct_plant.signals.joints import Joints, NamedTorques, OneShaft
from ddct_plant.signals.message_kind import MessageKind, Scalar
from ddct_plant.signals.points import PreviewPoints, TorqueRows
from ddct_plant.signals.sensed import REPEATED, Sensed, SensedQuantity
from ddct_plant.signals.signal import RunKind, Signal
from ddct_plant.signals.statuses import PhaseReport, SampleFlags, Status
from ddct_plant.signals.topic import Topic

JOINTS = JointValues._fields
"""Names of the joints in `driveline/joint_states`, in their order."""
SENSED_JOINTS = SensedJoints._fields
"""Joints whose speed a sensor measures."""
BASE_LINK = 'base_link'
"""Frame of the car's body (REP-105), x forward, for its motion and the torques of joints."""
ENGINE_LINK, CLUTCH_LINK, WHEEL_LINK = 'engine_link', 'clutch_link', 'wheel_link'
"""Frames whose x axis is the axis on which crankshaft, clutch and wheels turn."""


def _torque(
    name: str, publisher: str, frame: str, signal: str, about: str, **options: Any
) -> Topic:
    kind = Scalar('geometry_msgs/msg/WrenchStamped', 'wrench.torque.x')
    return Topic(name, kind, publisher, (Signal(signal, 'N m', about),), frame, **options)


def _status(name: str, publisher: str, **options: Any) -> Topic:
    kind = Status('diagnostic_msgs/msg/DiagnosticArray', options.pop('status_name', ''))
    return Topic(name, kind, publisher, **options)


def _two_input(run: RunKind) -> bool:
    return run.two_input


def _stick_slip(run: RunKind) -> bool:
    return run.clutch == STICK_SLIP


def _sensed(run: RunKind) -> bool:
    return run.sensed


def _shift(run: RunKind) -> bool:
    return run.shift


def _of_joints(
    prefix: str, quantity: str, joints: tuple[str, ...], unit: str, about: str
) -> Signal:
    """Return the signal with one value per joint, each named after its joint and the quantity."""
    parts = tuple(f'{prefix}{joint}_{quantity}' for joint in joints)
    return Signal(f'{prefix}joint_{quantity}', unit, about, len(joints), parts)


def _torque_row(name: str, about: str, **options: Any) -> Signal:
    return Signal(name, 'N m', f'{about}, at 0, 1, ..., 10 ms after t_k', SUBSTEPS + 1, **options)


def _sensor(name: str, true: Topic, flag: str = '', status: str = '') -> Topic:
    """
    Return the topic of a sensor of the one signal of the topic `true`; more follows from it.

    The sensor and its options have the name of the signal, its measurement the prefix `sensed_`.
    Flag and status of a repeated sample have their own names where these are given.
    """
    (signal,) = true.signals
    measured = replace(signal, name=f'sensed_{signal.name}', about=f'{signal.about}, as measured')
    flag = flag or f'{measured.name}_held'
    sensed = Sensed(
        (SensedQuantity(signal.name, signal.name, measured.name, flag),),
        Signal(flag, '1', REPEATED),
        (status or signal.name,),
    )
    return Topic(
        name, true.kind, true.publisher, (measured,), true.frame, when=_sensed, sensed=sensed
    )


def _shaft_sensors(*sensors: tuple[str, str]) -> Sensed:
    """Return the sensors of shaft speeds, each given by its name and its joint."""
    return Sensed(
        tuple(
            SensedQuantity(
                name,
                f'{joint}_speed',
                f'sensed_{joint}_speed',
                f'sensed_{joint}_held',
                f'{joint}_position',
            )
            for name, joint in sensors
        ),
        _of_joints('sensed_', 'held', SENSED_JOINTS, '1', REPEATED),
        SENSED_JOINTS,
    )


def _sensor_status(name: str, *sensed: Topic) -> Topic:
    """Return the topic of the flags of sensors whose measurements are on other topics."""
    each = [topic.sensed for topic in sensed if topic.sensed]
    kind = SampleFlags(
        'diagnostic_msgs/msg/DiagnosticArray', tuple(sensors.statuses for sensors in each)
    )
    flags = tuple(sensors.flags for sensors in each)
    return Topic(name, kind, sensed[0].publisher, flags, when=_sensed, later=True)


def _sensor_topics(publisher: str) -> tuple[Topic, ...]:
    """Return the topics of sensors of a node that are declared so far."""
    topics = (each for each in tuple(globals().values()) if isinstance(each, Topic))
    return tuple(each for each in topics if each.sensed and each.publisher == publisher)


_TRAJECTORY = 'trajectory_msgs/msg/JointTrajectory'


RUN_INFO = _status('run_info', 'every node', every_tick=False, latched=True)
OFF_GOING_RUN_INFO = _status(
    'off_going/run_info', 'every node of off_going', every_tick=False, latched=True, when=_shift
)
CLOCK = Topic('/clock', MessageKind('rosgraph_msgs/msg/Clock'), 'driveline')
JOINT_STATES = Topic(
    'driveline/joint_states',
    Joints('sensor_msgs/msg/JointState', JOINTS),
    'driveline',
    (
        _of_joints('', 'position', JOINTS, 'rad', 'angles from 0, theta_sr of the driveshaft'),
        _of_joints('', 'speed', JOINTS, 'rad/s', 'w_m, w_p, w_r, w_sr'),
        _of_joints('', 'effort', JOINTS, 'N m', 'C_m, transmitted C_f, C_load, shaft torque'),
    ),
    BASE_LINK,
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
    when=_shift,
)
SLIP = Topic(
    'clutch/slip',
    Scalar('geometry_msgs/msg/TwistStamped', 'twist.angular.x'),
    'driveline',
    (Signal('slip_speed', 'rad/s', 'w_d = w_m - w_p'),),
    CLUTCH_LINK,
)
OFF_GOING_SLIP = Topic(
    'off_going/clutch/slip',
    SLIP.kind,
    'driveline',
    (Signal('off_going_slip_speed', 'rad/s', 'w_m - w_p1'),),
    CLUTCH_LINK,
    when=_shift,
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
    when=_stick_slip,
)
OFF_GOING_PHASE = Topic(
    'off_going/clutch/phase',
    CLUTCH_PHASE.kind,
    'driveline',
    (
        Signal('off_going_clutch_phase', '1', '0 open, 1 slipping, 2 locked'),
        Signal('off_going_friction_work', 'J', 'exact, of the period that has ended'),
        Signal('off_going_phase_events', '', 'what happened at slip zero in it: `PhaseEvent`'),
    ),
    when=_shift,
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
SENSED_JOINT_STATES = Topic(
    'sensors/joint_states',
    Joints('sensor_msgs/msg/JointState', SENSED_JOINTS, ('velocity',)),
    'driveline',
    (_of_joints('sensed_', 'speed', SENSED_JOINTS, 'rad/s', 'w_m, w_p, w_r as measured'),),
    BASE_LINK,
    when=_sensed,
    sensed=_shaft_sensors(
        ('engine_speed', 'engine'), ('shaft_speed', 'primary_shaft'), ('wheel_speed', 'wheel')
    ),
)
SENSED_SLIP = Topic(
    'sensors/slip',
    SLIP.kind,
    'driveline',
    (Signal('sensed_slip_speed', 'rad/s', 'w_m - w_p as measured'),),
    CLUTCH_LINK,
    when=_sensed,
    sensed=Sensed((), Signal('sensed_slip_held', '1', REPEATED), ('slip',)),
)
SENSED_VEHICLE_SPEED = _sensor('sensors/twist', VEHICLE_SPEED, 'sensed_vehicle_held', 'vehicle')
SENSOR_STATUS = _sensor_status('sensors/status', *_sensor_topics('driveline'))
TORQUE_DEMAND = _torque(
    'engine/torque_demand', 'engine', ENGINE_LINK, 'torque_demand', "the driver's demand at t_k"
)
HANDOVER_SHARE = Topic(
    'clutch/handover_share',
    Scalar('geometry_msgs/msg/Vector3Stamped', 'vector.x', at_least=0.0, at_most=1.0),
    'handover',
    (Signal('handover_share', '1', 'of C_fOL, which the on-coming clutch carries; 1: feedback'),),
    CLUTCH_LINK,
    when=_shift,
)
OFF_GOING_TORQUE_REQUEST = _torque(
    'off_going/clutch/torque_request',
    'handover',
    CLUTCH_LINK,
    'off_going_torque_request',
    'before saturation',
    when=_shift,
)
TORQUE_CUT = Topic(
    'engine/torque_cut',
    Scalar('geometry_msgs/msg/WrenchStamped', 'wrench.torque.x', at_least=0.0),
    'handover',
    (Signal('torque_cut', 'N m', "taken off the driver's demand"),),
    ENGINE_LINK,
    when=_shift,
)
ENGINE_TORQUE = _torque(
    'engine/torque', 'engine', ENGINE_LINK, 'engine_torque', 'C_m, held over the period'
)
SENSED_ENGINE_TORQUE = _sensor('sensors/engine_torque', ENGINE_TORQUE, 'sensed_torque_held')
ENGINE_SENSOR_STATUS = _sensor_status('sensors/engine_torque_status', *_sensor_topics('engine'))
LOAD_TORQUE = _torque(
    'load/torque', 'load', WHEEL_LINK, 'load_torque', 'C_load, held over the period'
)
HOLDING_TORQUE = Topic(
    'load/holding_torque',
    Scalar('geometry_msgs/msg/WrenchStamped', 'wrench.torque.x', at_least=0.0),
    'load',
    (Signal('holding_torque', 'N m', 'capacity of rolling resistance and brake at the wheel'),),
    WHEEL_LINK,
    when=_stick_slip,
)
SLIP_REFERENCE = Topic(
    'clutch/slip_reference',
    PreviewPoints(_TRAJECTORY, ('clutch_slip',)),
    'reference',
    (
        Signal('slip_reference', 'rad/s', 'value i is i x 10 ms ahead', None),
        Signal('slip_reference_rate', 'rad/s^2', 'each over the period that follows', None),
    ),
    CLUTCH_LINK,
)
CONTROLLER_STATUS = _status(
    'controller/status',
    'controller',
    status_name='controller',
    signals=(Signal('status', '', 'the (key, value) pairs'),),
)
TORQUE_REQUEST = _torque(
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
    later=True,
    optional=True,
)
ENGINE_REQUEST = _torque(
    'engine/torque_request',
    'controller',
    ENGINE_LINK,
    'engine_torque_request',
    'requested of the engine',
    when=_two_input,
)
ACTUATOR_TORQUE = Topic(
    'actuator/torque',
    TorqueRows(_TRAJECTORY, ('clutch',)),
    'actuator',
    (_torque_row('actuator_torque', 'torque of the actuator'),),
    CLUTCH_LINK,
)
OFF_GOING_ACTUATOR_TORQUE = Topic(
    'off_going/actuator/torque',
    ACTUATOR_TORQUE.kind,
    'off_going/actuator',
    (_torque_row('off_going_actuator_torque', 'torque of the off-going actuator'),),
    CLUTCH_LINK,
    when=_shift,
)
CLUTCH_TORQUE = Topic(
    'clutch/torque',
    TorqueRows(_TRAJECTORY, ('clutch', 'clutch_static')),
    'clutch',
    (
        _torque_row(
            'clutch_torque',
            'torque after wear; of a clutch that sticks the capacity while it slips',
        ),
        _torque_row('clutch_static_torque', 'capacity while it sticks', when=_stick_slip),
    ),
    CLUTCH_LINK,
)
OFF_GOING_CLUTCH_TORQUE = Topic(
    'off_going/clutch/torque',
    CLUTCH_TORQUE.kind,
    'off_going/clutch',
    (
        _torque_row('off_going_clutch_torque', 'capacity of the off-going clutch while it slips'),
        _torque_row('off_going_clutch_static_torque', 'capacity while it sticks'),
    ),
    CLUTCH_LINK,
    when=_shift,
)
CLUTCH_TEMPERATURE = Topic(
    'clutch/temperature',
    Scalar('sensor_msgs/msg/Temperature', 'temperature'),
    'clutch',
    (Signal('clutch_temperature', 'degC', 'of the facing, which friction follows'),),
    CLUTCH_LINK,
    when=_stick_slip,
)
OFF_GOING_CLUTCH_TEMPERATURE = Topic(
    'off_going/clutch/temperature',
    CLUTCH_TEMPERATURE.kind,
    'off_going/clutch',
    (Signal('off_going_clutch_temperature', 'degC', 'of the facing of the off-going clutch'),),
    CLUTCH_LINK,
    when=_shift,
)
RECORDER_ACK = Topic('recorder/ack', MessageKind('std_msgs/msg/Header'), 'recorder')
CONTROLLER_TIMING = _status(
    'controller/timing',
    'controller',
    status_name='controller',
    every_tick=False,
    wall_clock=True,
)
DIAGNOSTICS = _status(
    '/diagnostics', 'driveline, engine, actuator', every_tick=False, wall_clock=True
)


@dataclass(frozen=True)
class MeasurementTopics:
    """Topics from which controller and reference read the plant: of the sensors, or true."""

    joint_states: Topic
    """Topic of w_m, w_p and w_r."""
    slip: Topic
    """Topic of w_d."""
    vehicle_speed: Topic
    """Topic of V_x."""
    engine_torque: Topic
    """Topic of C_m."""


def measurement_topics(*, sensed: bool) -> MeasurementTopics:
    """Return the topics of the sensors for a run that has them, else those of the true signals."""
    if sensed:
        return MeasurementTopics(
            SENSED_JOINT_STATES, SENSED_SLIP, SENSED_VEHICLE_SPEED, SENSED_ENGINE_TORQUE
        )
    return MeasurementTopics(JOINT_STATES, SLIP, VEHICLE_SPEED, ENGINE_TORQUE)


TOPICS = tuple(each for each in tuple(globals().values()) if isinstance(each, Topic))
"""All topics: `run_info`, then the topics of each tick with `recorder/ack` last, then those of the
wall clock."""


SENSED_TOPICS = tuple(topic for topic in TOPICS if topic.when is _sensed)
"""Topics of the sensors."""
SHIFT_TOPICS = tuple(topic for topic in TOPICS if topic.when is _shift)
"""Topics of the off-going clutch and of the handover."""


def sensed_quantities(publisher: str = '') -> tuple[SensedQuantity, ...]:
    """Return the quantities that sensors measure, all or those that one node publishes."""
    topics = (each for each in TOPICS if publisher in ('', each.publisher))
    return tuple(each for topic in topics if topic.sensed for each in topic.sensed.quantities)


def sensed_signals(publisher: str) -> tuple[Signal, ...]:
    """Return the signals of sensors that a node publishes, measurements and flags."""
    topics = (each for each in SENSED_TOPICS if each.publisher == publisher)
    return tuple(signal for topic in topics for signal in topic.signals)


def all_topics() -> tuple[Topic, ...]:
    """Return all topics, in the order of the table."""
    return TOPICS


def recorded_topics(run: RunKind) -> tuple[Topic, ...]:
    """Return the topics that the recording of a run has, in writing order."""
    return tuple(
        topic for topic in TOPICS if topic.in_run(run) and not (run.lockstep and topic.wall_clock)
    )


def signals_of(run: RunKind) -> tuple[Signal, ...]:
    """Return the signals that a run has."""
    return tuple(each for topic in recorded_topics(run) for each in topic.signals_in(run))


def tick_names() -> frozenset[str]:
    """Return the names of the topics that the owner of time publishes with every tick."""
    return frozenset(topic.name for topic in TOPICS if topic.is_tick)


def all_signals() -> tuple[Signal, ...]:
    """Return every signal: numbers, then text, and last the signals of some runs only."""
    ranked = [
        ((bool(topic.when or signal.when), not signal.unit), signal)
        for topic in TOPICS
        for signal in topic.signals
    ]
    return tuple(signal for _, signal in sorted(ranked, key=itemgetter(0)))


def quantities() -> Mapping[str, tuple[Signal, int | None]]:
    """
    Return by name of each quantity its signal, and the index of its value at the tick in a row.

    The index is None for a signal with one value.
    """
    return _quantities(TOPICS)


@cache
def _quantities(topics: tuple[Topic, ...]) -> Mapping[str, tuple[Signal, int | None]]:
    return {
        name: (signal, None if signal.size == 1 else index)
        for topic in topics
        for signal in topic.signals
        for index, name in enumerate(signal.quantities)
    }
