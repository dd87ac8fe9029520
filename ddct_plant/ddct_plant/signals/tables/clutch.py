# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics of the actuator and of the clutch."""

from ddct_plant.signals.message_kind import Scalar
from ddct_plant.signals.points import TorqueRows
from ddct_plant.signals.signal import Signal
from ddct_plant.signals.tables.rows import CLUTCH_LINK, TRAJECTORY, if_stick_slip, torque_row
from ddct_plant.signals.topic import Topic

ACTUATOR_TORQUE = Topic(
    'actuator/torque',
    TorqueRows(TRAJECTORY, ('clutch',)),
    'actuator',
    (torque_row('actuator_torque', 'torque of the actuator'),),
    CLUTCH_LINK,
)
CLUTCH_TORQUE = Topic(
    'clutch/torque',
    TorqueRows(TRAJECTORY, ('clutch', 'clutch_static')),
    'clutch',
    (
        torque_row(
            'clutch_torque',
            'torque after wear; of a clutch that sticks the capacity while it slips',
        ),
        torque_row('clutch_static_torque', 'capacity while it sticks', when=if_stick_slip),
    ),
    CLUTCH_LINK,
)
CLUTCH_TEMPERATURE = Topic(
    'clutch/temperature',
    Scalar('sensor_msgs/msg/Temperature', 'temperature'),
    'clutch',
    (Signal('clutch_temperature', 'degC', 'of the facing, which friction follows'),),
    CLUTCH_LINK,
    when=if_stick_slip,
)
