# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics of the engine, of the load and of the friction at the wheels."""

from ddct_plant.signals.message_kind import Scalar
from ddct_plant.signals.signal import Signal
from ddct_plant.signals.tables.rows import ENGINE_LINK, WHEEL_LINK, if_stick_slip, torque_topic
from ddct_plant.signals.topic import Topic

TORQUE_DEMAND = torque_topic(
    'engine/torque_demand', 'engine', ENGINE_LINK, 'torque_demand', "the driver's demand at t_k"
)
ENGINE_TORQUE = torque_topic(
    'engine/torque', 'engine', ENGINE_LINK, 'engine_torque', 'C_m, held over the period'
)
LOAD_TORQUE = torque_topic(
    'load/torque', 'load', WHEEL_LINK, 'load_torque', 'C_load, held over the period'
)
HOLDING_TORQUE = Topic(
    'load/holding_torque',
    Scalar('geometry_msgs/msg/WrenchStamped', 'wrench.torque.x', at_least=0.0),
    'load',
    (Signal('holding_torque', 'N m', 'capacity of rolling resistance and brake at the wheel'),),
    WHEEL_LINK,
    when=if_stick_slip,
)
