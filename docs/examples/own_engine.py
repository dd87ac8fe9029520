# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node `engine` in place of ours, without our packages: 308 N m after a rise of 0.524 s."""

from contextlib import suppress

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import WrenchStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState

RISE_S, TORQUE_N_M = 0.524, 308.0


class OwnEngine(Node):
    """Answer `driveline/joint_states` with what the driver demands and what is delivered."""

    def __init__(self) -> None:
        super().__init__('engine')
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.run_info = self.create_publisher(DiagnosticArray, 'run_info', latched)
        self.run_info.publish(DiagnosticArray(status=[DiagnosticStatus(name='engine')]))
        self.demands = self.create_publisher(WrenchStamped, 'engine/torque_demand', 10)
        self.torques = self.create_publisher(WrenchStamped, 'engine/torque', 10)
        self.create_subscription(JointState, 'driveline/joint_states', self.answer, 10)

    def answer(self, state: JointState) -> None:
        """Answer with the same stamp; a stamp that comes again gets the same answer."""
        stamp = state.header.stamp
        step = (stamp.sec - 1) * 100 + stamp.nanosec // 10_000_000
        reply = WrenchStamped(header=state.header)
        reply.header.frame_id = 'engine_link'
        reply.wrench.torque.x = TORQUE_N_M * min(step / 100 / RISE_S, 1.0)
        self.demands.publish(reply)
        self.torques.publish(reply)


rclpy.init()
with suppress(KeyboardInterrupt, ExternalShutdownException):
    rclpy.spin(OwnEngine())
