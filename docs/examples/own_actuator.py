# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node `actuator` in place of ours, without our packages; it opens when requests stop."""

from contextlib import suppress

import rclpy
from builtin_interfaces.msg import Duration, Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import WrenchStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

START_NS, TIMEOUT_NS, FALL_N_M = 1_000_000_000, 50_000_000, 10.0


class OwnActuator(Node):
    """Answer `clutch/torque_request` by a torque that reaches it in 10 ms; watch `/clock`."""

    def __init__(self) -> None:
        super().__init__('actuator')
        self.last_ns, self.torque, self.opens = -1, 0.0, False
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.run_info = self.create_publisher(DiagnosticArray, 'run_info', latched)
        self.run_info.publish(DiagnosticArray(status=[DiagnosticStatus(name='actuator')]))
        self.torques = self.create_publisher(JointTrajectory, 'actuator/torque', 10)
        self.create_subscription(WrenchStamped, 'clutch/torque_request', self.answer, 10)
        self.create_subscription(Clock, '/clock', self.watch, 10)

    def answer(self, request: WrenchStamped) -> None:
        """Answer with the same stamp; a stamp that comes again gets the same answer."""
        if not self.opens:
            self.deliver(request.header.stamp, max(request.wrench.torque.x, 0.0))

    def watch(self, tick: Clock) -> None:
        """Open, for good, at the tick at which no request has come for longer than the timeout."""
        now_ns = tick.clock.sec * 1_000_000_000 + tick.clock.nanosec
        self.opens |= now_ns - max(self.last_ns, START_NS) > TIMEOUT_NS
        if self.opens:
            self.deliver(tick.clock, max(self.torque - FALL_N_M, 0.0))

    def deliver(self, stamp: Time, end: float) -> None:
        """Publish eleven torques, 1 ms apart, on a line from the last torque to `end` in N m."""
        stamp_ns = stamp.sec * 1_000_000_000 + stamp.nanosec
        if stamp_ns > self.last_ns:
            rise, self.reply = (end - self.torque) / 10, JointTrajectory(joint_names=['clutch'])
            self.reply.header.stamp, self.reply.header.frame_id = stamp, 'clutch_link'
            self.reply.points = [
                JointTrajectoryPoint(
                    effort=[self.torque + i * rise], time_from_start=Duration(nanosec=i * 10**6)
                )
                for i in range(11)
            ]
            self.last_ns, self.torque = stamp_ns, end
        self.torques.publish(self.reply)


rclpy.init()
with suppress(KeyboardInterrupt, ExternalShutdownException):
    rclpy.spin(OwnActuator())
