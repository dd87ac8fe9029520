# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics of the sensors; a sensor of a signal that the driveline publishes is one line."""

from dataclasses import replace

from ddct_plant.signals.joints import Joints
from ddct_plant.signals.sensed import REPEATED, Sensed, SensedQuantity
from ddct_plant.signals.signal import Signal
from ddct_plant.signals.statuses import SampleFlags
from ddct_plant.signals.tables import driveline, engine_and_load
from ddct_plant.signals.tables.rows import (
    BASE_LINK,
    CLUTCH_LINK,
    SENSED_JOINTS,
    if_sensed,
    joint_signal,
)
from ddct_plant.signals.topic import Topic


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
        name, true.kind, true.publisher, (measured,), true.frame, when=if_sensed, sensed=sensed
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
        joint_signal('sensed_', 'held', SENSED_JOINTS, '1', REPEATED),
        SENSED_JOINTS,
    )


def _sensor_status(name: str, *sensed: Topic) -> Topic:
    """Return the topic of the flags of sensors whose measurements are on other topics."""
    each = [topic.sensed for topic in sensed if topic.sensed]
    kind = SampleFlags(
        'diagnostic_msgs/msg/DiagnosticArray', tuple(sensors.statuses for sensors in each)
    )
    flags = tuple(sensors.flags for sensors in each)
    return Topic(name, kind, sensed[0].publisher, flags, when=if_sensed)


def _sensors_of(publisher: str) -> tuple[Topic, ...]:
    """Return the topics of this module that a node publishes, as declared so far."""
    topics = (each for each in tuple(globals().values()) if isinstance(each, Topic))
    return tuple(each for each in topics if each.publisher == publisher and each.when is if_sensed)


SENSED_JOINT_STATES = Topic(
    'sensors/joint_states',
    Joints('sensor_msgs/msg/JointState', SENSED_JOINTS, ('velocity',)),
    'driveline',
    (joint_signal('sensed_', 'speed', SENSED_JOINTS, 'rad/s', 'w_m, w_p, w_r as measured'),),
    BASE_LINK,
    when=if_sensed,
    sensed=_shaft_sensors(
        ('engine_speed', 'engine'), ('shaft_speed', 'primary_shaft'), ('wheel_speed', 'wheel')
    ),
)
SENSED_SLIP = Topic(
    'sensors/slip',
    driveline.SLIP.kind,
    'driveline',
    (Signal('sensed_slip_speed', 'rad/s', 'w_m - w_p as measured'),),
    CLUTCH_LINK,
    when=if_sensed,
    sensed=Sensed((), Signal('sensed_slip_held', '1', REPEATED), ('slip',)),
)
SENSED_VEHICLE_SPEED = _sensor(
    'sensors/twist', driveline.VEHICLE_SPEED, 'sensed_vehicle_held', 'vehicle'
)
SENSOR_STATUS = _sensor_status('sensors/status', *_sensors_of('driveline'))
SENSED_ENGINE_TORQUE = _sensor(
    'sensors/engine_torque', engine_and_load.ENGINE_TORQUE, 'sensed_torque_held'
)
ENGINE_SENSOR_STATUS = _sensor_status('sensors/engine_torque_status', *_sensors_of('engine'))
DRIVELINE_SENSORS, ENGINE_SENSORS = _sensors_of('driveline'), _sensors_of('engine')
"""Topics of the sensors by the node that publishes them, the flags last."""
