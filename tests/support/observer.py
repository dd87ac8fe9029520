# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subscriber that is no part of the graph, for runs without a recorder."""

from typing import Any

import numpy as np
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.graph.spin import make_executor
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topics import CLUTCH_TORQUE


class Observer(Node):
    """Node that stores the messages of `driveline/joint_states` and `clutch/torque` by step."""

    def __init__(self, **options: Any) -> None:
        """Subscribe; nothing in the graph waits for this node."""
        super().__init__('observer', **options)
        self.joints: dict[int, JointState] = {}
        self.clutch_torque: dict[int, list[float]] = {}
        self.create_subscription(
            JointState, 'driveline/joint_states', self._on_joints, RECORDER_QOS
        )
        self.create_subscription(JointTrajectory, 'clutch/torque', self._on_torque, RECORDER_QOS)

    def _on_joints(self, message: JointState) -> None:
        self.joints[step_of_stamp(stamp_ns(message))] = message

    def _on_torque(self, message: JointTrajectory) -> None:
        self.clutch_torque[step_of_stamp(stamp_ns(message))] = CLUTCH_TORQUE.read(message)[0]

    def require_same(self, trajectory: Trajectory) -> None:
        """
        Require the reply to the last tick, and each received tick, to the last bit.

        The driveline waits for no observer, so its own last message may be lost on a busy machine.
        """
        assert trajectory.steps in self.clutch_torque, sorted(self.clutch_torque)[-3:]
        for step, joints in self.joints.items():
            assert np.array_equal(joints.position, trajectory.joint_position[step]), step
            assert np.array_equal(joints.velocity, trajectory.joint_speed[step]), step
            assert np.array_equal(joints.effort, trajectory.joint_effort[step]), step
        for step, torques in self.clutch_torque.items():
            assert np.array_equal(torques, trajectory.clutch_torque[step]), step


class Observing:
    """An observer in a context of its own; as a context manager it ends with the block."""

    def __init__(self) -> None:
        """Join the domain of the test."""
        self._context = Context()
        rclpy.init(args=[], context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self.observer = Observer(context=self._context)
        self._executor = make_executor(self._context)
        self._executor.add_node(self.observer)

    def __enter__(self) -> 'Observing':
        return self

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self.observer.destroy_node()
        self._context.try_shutdown()

    def listen(self) -> bool:
        """Spin for a moment; return True, for use in a condition."""
        self._executor.spin_until_future_complete(Future(), 0.02)
        return True
