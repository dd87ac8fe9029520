# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node `controller` in place of ours, without our packages: a PI on the slip error in rpm."""

import math
from contextlib import suppress

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TwistStamped, WrenchStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from trajectory_msgs.msg import JointTrajectory

K_P, K_I, PERIOD_S, RPM = 0.2, 0.6, 0.01, 30.0 / math.pi
ABOUT = DiagnosticStatus(name='controller', values=[KeyValue(key='controller', value='own_pi')])
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class OwnController(Node):
    """Answer each stamp that `clutch/slip` and `clutch/slip_reference` both carry."""

    def __init__(self) -> None:
        super().__init__('controller')
        self.request, self.integral = WrenchStamped(), 0.0
        self.last = {kind: kind() for kind in (TwistStamped, JointTrajectory)}
        self.create_subscription(TwistStamped, 'clutch/slip', self.answer, 10)
        self.create_subscription(JointTrajectory, 'clutch/slip_reference', self.answer, 10)
        self.requests = self.create_publisher(WrenchStamped, 'clutch/torque_request', 10)
        self.statuses = self.create_publisher(DiagnosticArray, 'controller/status', 10)
        self.run_info = self.create_publisher(DiagnosticArray, 'run_info', LATCHED)
        self.run_info.publish(DiagnosticArray(status=[ABOUT]))

    def answer(self, message: TwistStamped | JointTrajectory) -> None:
        """Answer once both inputs are there; a stamp that comes again gets the same answer."""
        self.last[type(message)] = message
        slip, reference = self.last[TwistStamped], self.last[JointTrajectory]
        if slip.header.stamp != reference.header.stamp:
            return
        if slip.header.stamp != self.request.header.stamp:
            error_rpm = (reference.points[0].velocities[0] - slip.twist.angular.x) * RPM
            self.request = WrenchStamped(header=slip.header)
            self.request.wrench.torque.x = -(K_P * error_rpm + K_I * self.integral)
            self.integral += PERIOD_S * error_rpm
        self.requests.publish(self.request)
        self.statuses.publish(DiagnosticArray(header=slip.header, status=[ABOUT]))


rclpy.init()
with suppress(KeyboardInterrupt, ExternalShutdownException):
    rclpy.spin(OwnController())
