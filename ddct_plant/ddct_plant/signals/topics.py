# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The table of topics and signals, in the order in which a tick is written; independent of ROS.

A row has the name, message, publisher, frame and signals of a topic, and when a run has it. Nodes,
recorder, reader, trajectory, the tables of signals and the live view take all that from here. A
new topic is a row at its place, and the node that publishes it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from operator import itemgetter
from typing import Any

from ddct_plant.base.timebase import PERIOD_NS, SUBSTEP_NS, SUBSTEPS
from ddct_plant.models.driveline import JointValues, SensedJoints
from ddct_plant.shift.balance import LEAST_DEVIATION, OnComingShare
from ddct_plant.signals.joint_messages import Joints, Points
from ddct_plant.signals.message_kind import Number, Numbers
from ddct_plant.signals.statuses import (
    FRICTION_WORK,
    TIE_UP_WORK,
    FlagsForm,
    PairsForm,
    PhaseForm,
    Statuses,
)
from ddct_plant.signals.topic import (
    RunKind,
    Signal,
    Topic,
    if_sensed,
    if_shift,
    if_stick_slip,
    if_two_input,
)

_BODY = 'base_link'
"""Frame of the car's body (REP-105), x forward: of its motion, and of what joints carry."""
_ENGINE, _CLUTCH, _WHEEL = 'engine_link', 'clutch_link', 'wheel_link'
"""Frames whose x axis is the axis on which crankshaft, clutch and wheels turn."""
_JOINTS, _SENSED_JOINTS = JointValues._fields, SensedJoints._fields
"""Names of the joints in `driveline/joint_states`, and of those whose speed a sensor measures."""

_TWIST, _WRENCH = 'geometry_msgs/msg/TwistStamped', 'geometry_msgs/msg/WrenchStamped'
_SLIP = Numbers(_TWIST, 'twist.angular', (Number('x'),))
_SPEED = Numbers(_TWIST, 'twist.linear', (Number('x'),))
_ACCEL = Numbers('geometry_msgs/msg/AccelStamped', 'accel.linear', (Number('x'),))
_TORQUE = Numbers(_WRENCH, 'wrench.torque', (Number('x'),))
_POSITIVE = Numbers(_WRENCH, 'wrench.torque', (Number('x', at_least=0.0),))
_TEMPERATURE = Numbers('sensor_msgs/msg/Temperature', numbers=(Number('temperature'),))
_SHARE = Numbers(
    'geometry_msgs/msg/Vector3Stamped',
    'vector',
    (Number('x', 0.0, 1.0), Number('y', LEAST_DEVIATION), Number('z')),
    OnComingShare,
)
_STATES = Joints(_JOINTS, of=JointValues)
_SPEEDS = Joints(_SENSED_JOINTS, ('velocity',), of=SensedJoints)
_SHAFT = Joints(('primary_shaft',), apart=True)
_PARTS = Joints(('open_loop', 'closed_loop', 'closing'), ('effort',), apart=True)
_TORQUES = Points(('clutch',), ('effort',), SUBSTEP_NS, SUBSTEPS + 1)
_CAPACITIES = Points(('clutch', 'clutch_static'), ('effort',), SUBSTEP_NS, SUBSTEPS + 1)
_PREVIEW = Points(('clutch_slip',), ('velocities', 'accelerations'), PERIOD_NS)
_PAIRS, _OF_CONTROLLER = Statuses(PairsForm()), Statuses(PairsForm(('controller',)))
_PHASE, _BOTH = Statuses(PhaseForm()), Statuses(PhaseForm((FRICTION_WORK, TIE_UP_WORK)))
_FLAGS = Statuses(FlagsForm((_SENSED_JOINTS, ('slip',), ('vehicle',))))
_FLAG = Statuses(FlagsForm((('engine_torque',),)))

_PHASES, _WORK = '0 open, 1 slipping, 2 locked', 'exact, of the period that has ended'
_EVENTS = 'what happened at slip zero in it: `PhaseEvent`'
_HELD = '1 where the last value is repeated, else 0'


def _by_joint(name: str, joints: tuple[str, ...], unit: str, about: str) -> Signal:
    """Return the signal with one value per joint, each named after its joint and the quantity."""
    prefix, _, quantity = name.rpartition('joint_')
    parts = tuple(f'{prefix}{joint}_{quantity}' for joint in joints)
    return Signal(name, unit, about, len(joints), parts)


def _within(name: str, about: str, **options: Any) -> Signal:
    """Return the signal of a torque within a period."""
    return Signal(name, 'N m', f'{about}, at 0, 1, ..., 10 ms after t_k', SUBSTEPS + 1, **options)


_ROWS: list[Topic] = []


def _row(
    name: str, kind: Any, publisher: str, frame: str, *signals: Signal, **marks: Any
) -> Topic:
    """Return a topic with `marks` as its other fields, and put it at the end of the table."""
    _ROWS.append(Topic(name, kind, publisher, signals, frame, **marks))
    return _ROWS[-1]


# fmt: off
# name, message, publisher, frame, then each signal: name, unit, meaning
RUN_INFO = _row('run_info', _PAIRS, 'every node', '', every_tick=False, latched=True)
OFF_GOING_RUN_INFO = _row('off_going/run_info', _PAIRS, 'every node of off_going', '',
    every_tick=False, latched=True, when=if_shift)
CLOCK = _row('/clock', Numbers('rosgraph_msgs/msg/Clock'), 'driveline', '')
JOINT_STATES = _row('driveline/joint_states', _STATES, 'driveline', _BODY,
    _by_joint('joint_position', _JOINTS, 'rad', 'angles from 0, theta_sr of the driveshaft'),
    _by_joint('joint_speed', _JOINTS, 'rad/s', 'w_m, w_p, w_r, w_sr'),
    _by_joint('joint_effort', _JOINTS, 'N m', 'C_m, transmitted C_f, C_load, shaft torque'))
OFF_GOING_JOINT_STATES = _row('off_going/joint_states', _SHAFT, 'driveline', _BODY,
    Signal('off_going_shaft_angle', 'rad', 'angle of the off-going primary shaft from 0'),
    Signal('off_going_shaft_speed', 'rad/s', 'w_p1, speed of the off-going primary shaft'),
    Signal('off_going_transmitted_torque', 'N m', 'C_1, transmitted by the off-going clutch'),
    when=if_shift)
SLIP = _row('clutch/slip', _SLIP, 'driveline', _CLUTCH,
    Signal('slip_speed', 'rad/s', 'w_d = w_m - w_p'))
OFF_GOING_SLIP = _row('off_going/clutch/slip', _SLIP, 'driveline', _CLUTCH,
    Signal('off_going_slip_speed', 'rad/s', 'w_m - w_p1'), when=if_shift)
CLUTCH_PHASE = _row('clutch/phase', _PHASE, 'driveline', '',
    Signal('clutch_phase', '1', _PHASES), Signal('friction_work', 'J', _WORK),
    Signal('phase_events', '', _EVENTS), when=if_stick_slip)
OFF_GOING_PHASE = _row('off_going/clutch/phase', _BOTH, 'driveline', '',
    Signal('off_going_clutch_phase', '1', _PHASES), Signal('off_going_friction_work', 'J', _WORK),
    Signal('tie_up_work', 'J', 'exact, of both clutches against each other in it'),
    Signal('off_going_phase_events', '', _EVENTS), when=if_shift)
VEHICLE_SPEED = _row('vehicle/twist', _SPEED, 'driveline', _BODY,
    Signal('vehicle_speed', 'm/s', 'V_x'))
VEHICLE_ACCEL = _row('vehicle/accel', _ACCEL, 'driveline', _BODY,
    Signal('vehicle_accel', 'm/s^2', 'A_x'))
SENSED_JOINT_STATES = _row('sensors/joint_states', _SPEEDS, 'driveline', _BODY,
    _by_joint('sensed_joint_speed', _SENSED_JOINTS, 'rad/s', 'w_m, w_p, w_r as measured'),
    when=if_sensed)
SENSED_SLIP = _row('sensors/slip', _SLIP, 'driveline', _CLUTCH,
    Signal('sensed_slip_speed', 'rad/s', 'w_m - w_p as measured'), when=if_sensed)
SENSED_VEHICLE_SPEED = _row('sensors/twist', _SPEED, 'driveline', _BODY,
    Signal('sensed_vehicle_speed', 'm/s', 'V_x as measured'), when=if_sensed)
SENSOR_STATUS = _row('sensors/status', _FLAGS, 'driveline', '',
    _by_joint('sensed_joint_held', _SENSED_JOINTS, '1', _HELD),
    Signal('sensed_slip_held', '1', _HELD), Signal('sensed_vehicle_held', '1', _HELD),
    when=if_sensed)
TORQUE_DEMAND = _row('engine/torque_demand', _TORQUE, 'engine', _ENGINE,
    Signal('torque_demand', 'N m', "the driver's demand at t_k"))
HANDOVER_SHARE = _row('clutch/handover_share', _SHARE, 'handover', _CLUTCH,
    Signal('handover_share', '1', 'of C_fOL, which the on-coming clutch carries; 1: feedback'),
    Signal('on_coming_wear_deviation', '1', 'estimate of its wear gain less 1'),
    Signal('on_coming_torque_offset', 'N m', 'estimate of what it carries beyond that gain'),
    when=if_shift)
OFF_GOING_TORQUE_REQUEST = _row('off_going/clutch/torque_request', _TORQUE, 'handover', _CLUTCH,
    Signal('off_going_torque_request', 'N m', 'before saturation'), when=if_shift)
TORQUE_CUT = _row('engine/torque_cut', _POSITIVE, 'handover', _ENGINE,
    Signal('torque_cut', 'N m', "taken off the driver's demand"), when=if_shift)
ENGINE_TORQUE = _row('engine/torque', _TORQUE, 'engine', _ENGINE,
    Signal('engine_torque', 'N m', 'C_m, held over the period'))
SENSED_ENGINE_TORQUE = _row('sensors/engine_torque', _TORQUE, 'engine', _ENGINE,
    Signal('sensed_engine_torque', 'N m', 'C_m, held over the period, as measured'),
    when=if_sensed)
ENGINE_SENSOR_STATUS = _row('sensors/engine_torque_status', _FLAG, 'engine', '',
    Signal('sensed_torque_held', '1', _HELD), when=if_sensed)
LOAD_TORQUE = _row('load/torque', _TORQUE, 'load', _WHEEL,
    Signal('load_torque', 'N m', 'C_load, held over the period'))
HOLDING_TORQUE = _row('load/holding_torque', _POSITIVE, 'load', _WHEEL,
    Signal('holding_torque', 'N m', 'capacity of rolling resistance and brake at the wheel'),
    when=if_stick_slip)
SLIP_REFERENCE = _row('clutch/slip_reference', _PREVIEW, 'reference', _CLUTCH,
    Signal('slip_reference', 'rad/s', 'value i is i x 10 ms ahead', None),
    Signal('slip_reference_rate', 'rad/s^2', 'each over the period that follows', None))
CONTROLLER_STATUS = _row('controller/status', _OF_CONTROLLER, 'controller', '',
    Signal('status', '', 'the (key, value) pairs'))
TORQUE_REQUEST = _row('clutch/torque_request', _TORQUE, 'controller', _CLUTCH,
    Signal('torque_request', 'N m', 'before saturation'))
TORQUE_PARTS = _row('controller/torque_parts', _PARTS, 'controller', _CLUTCH,
    Signal('open_loop_torque', 'N m', 'part of the request without feedback'),
    Signal('closed_loop_torque', 'N m', 'part of the request that feedback gives'),
    Signal('closing_torque', 'N m', 'share of the closing stage in open_loop_torque'),
    optional=True)
ENGINE_REQUEST = _row('engine/torque_request', _TORQUE, 'controller', _ENGINE,
    Signal('engine_torque_request', 'N m', 'requested of the engine'), when=if_two_input)
ACTUATOR_TORQUE = _row('actuator/torque', _TORQUES, 'actuator', _CLUTCH,
    _within('actuator_torque', 'torque of the actuator'))
OFF_GOING_ACTUATOR_TORQUE = _row(
    'off_going/actuator/torque', _TORQUES, 'off_going/actuator', _CLUTCH,
    _within('off_going_actuator_torque', 'torque of the off-going actuator'), when=if_shift)
CLUTCH_TORQUE = _row('clutch/torque', _CAPACITIES, 'clutch', _CLUTCH,
    _within('clutch_torque',
        'torque after wear; of a clutch that sticks the capacity while it slips'),
    _within('clutch_static_torque', 'capacity while it sticks', when=if_stick_slip))
OFF_GOING_CLUTCH_TORQUE = _row('off_going/clutch/torque', _CAPACITIES, 'off_going/clutch', _CLUTCH,
    _within('off_going_clutch_torque', 'capacity of the off-going clutch while it slips'),
    _within('off_going_clutch_static_torque', 'capacity while it sticks'), when=if_shift)
CLUTCH_TEMPERATURE = _row('clutch/temperature', _TEMPERATURE, 'clutch', _CLUTCH,
    Signal('clutch_temperature', 'degC', 'of the facing, which friction follows'),
    when=if_stick_slip)
OFF_GOING_CLUTCH_TEMPERATURE = _row(
    'off_going/clutch/temperature', _TEMPERATURE, 'off_going/clutch', _CLUTCH,
    Signal('off_going_clutch_temperature', 'degC', 'of the facing of the off-going clutch'),
    when=if_shift)
RECORDER_ACK = _row('recorder/ack', Numbers('std_msgs/msg/Header'), 'recorder', '')
CONTROLLER_TIMING = _row('controller/timing', _OF_CONTROLLER, 'controller', '',
    every_tick=False, wall_clock=True)
DIAGNOSTICS = _row('/diagnostics', _PAIRS, 'driveline, engine, actuator', '',
    every_tick=False, wall_clock=True)
# fmt: on

TOPICS = tuple(_ROWS)
"""All topics: `run_info`, then the topics of each tick with `recorder/ack` last, then those of the
wall clock."""
RUN_SETTINGS = Topic('run_settings', _PAIRS, 'recorder', every_tick=False, latched=True)
"""
Settings of the run, which nodes that are started by hand compare with their own.

It is in no recording, which has the settings once in its metadata, and so not in the table.
"""
OFF_GOING_RUN_SETTINGS = replace(RUN_SETTINGS, name='off_going/run_settings', when=if_shift)
"""As `run_settings`, for the nodes of the off-going side."""
SENSED_TOPICS = tuple(topic for topic in TOPICS if topic.when is if_sensed)
"""Topics of the sensors."""
SHIFT_TOPICS = tuple(topic for topic in TOPICS if topic.when is if_shift)
"""Topics of the off-going clutch and of the handover."""


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
