"""Node `controller`: runs the controller that its `controller` parameter names, every tick."""

import time
from typing import Any, ClassVar

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TwistStamped, WrenchStamped
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from ddct_controllers.architecture import make_architecture
from ddct_controllers.controller_info import controller_info
from ddct_controllers.interface import Measurement
from ddct_controllers.registry import controller_label, controller_names, make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.graph.arrivals import (
    read_joint_speeds,
    read_slip_reference,
    read_torque,
    read_vehicle_speed,
)
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.messages import StatusMessage, status_message, torque_message
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.settings import declare
from ddct_plant.graph.spin import run_node

TIMING_BATCH = 20
"""Update times are published in batches of this many steps."""
_ABOUT_GAINS = 'May be changed while it runs; its unit is in the documentation of the controller'


class ControllerNode(FollowerNode):
    """
    Answer the measurements of a tick with `clutch/torque_request` and `controller/status`.

    A controller with two inputs also answers with `engine/torque_request`, and takes the driver's
    demand in place of `engine/torque`. Gains are parameters `gains.<name>`, which may be changed
    while it runs.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = (
        '-p controller:=ls8',
        '-p controller:=pi -p gains.proportional_gain:=0.2',
    )

    def __init__(self, **kwargs: Any) -> None:
        """Build the controller that the `controller` parameter names."""
        super().__init__('controller', **kwargs)
        name = declare(self, 'controller', 'pi', f'One of: {", ".join(controller_names())}')
        self._controller = make_controller(name, self.settings)
        self._architecture = make_architecture(self.settings, self._controller)
        self._request = self.create_publisher(WrenchStamped, 'clutch/torque_request', LOOP_QOS)
        if self._controller.commands_engine:
            self._engine_request = self.create_publisher(
                WrenchStamped, 'engine/torque_request', LOOP_QOS
            )
            self._engine_request_message = WrenchStamped()
            self._engine_topic = 'engine/torque_demand'
        else:
            self._engine_topic = 'engine/torque'
        self._status = self.create_publisher(DiagnosticArray, 'controller/status', LOOP_QOS)
        self._timing = self.create_publisher(DiagnosticArray, 'controller/timing', LOOP_QOS)
        self._request_message = WrenchStamped()
        self._status_message = StatusMessage(self.get_name())
        self._update_times_us: list[float] = []
        self._declare_gains()
        self.publish_run_info(controller_info(controller_label(name), self._controller))
        self.follow(
            [
                (JointState, 'driveline/joint_states', read_joint_speeds),
                (TwistStamped, 'vehicle/twist', read_vehicle_speed),
                (WrenchStamped, self._engine_topic, read_torque),
                (JointTrajectory, 'clutch/slip_reference', self._read_reference),
            ]
        )

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the request for the period of step k and what it is made of."""
        measurement = self._measure(step, inputs)
        started = time.perf_counter()
        request = self._architecture.update(measurement)
        self._note_update_time(step, 1e6 * (time.perf_counter() - started))
        reply = (
            (
                self._request,
                torque_message(stamp_ns, request.torque, reuse=self._request_message),
            ),
            (self._status, self._status_message.fill(stamp_ns, request.status)),
        )
        if request.engine_torque is None:
            return reply
        engine_request = torque_message(
            stamp_ns, request.engine_torque, reuse=self._engine_request_message
        )
        return ((self._engine_request, engine_request), *reply)

    def close(self) -> None:
        """Publish the update times that no batch has carried yet."""
        if self._update_times_us and self.join.last_step is not None:
            self._publish_timing(self.join.last_step)

    def _read_reference(self, topic: str, message: Any) -> tuple[list[float], list[float]]:
        return read_slip_reference(topic, message, self._controller.preview_steps)

    def _measure(self, step: int, inputs: dict[str, Any]) -> Measurement:
        engine, shaft, wheel = inputs['driveline/joint_states']
        speeds, rates = inputs['clutch/slip_reference']
        return Measurement(
            step=step,
            engine_speed=engine,
            shaft_speed=shaft,
            wheel_speed=wheel,
            vehicle_speed=inputs['vehicle/twist'],
            engine_torque=inputs[self._engine_topic],
            slip_reference=speeds,
            slip_reference_rate=rates,
        )

    def _note_update_time(self, step: int, update_time_us: float) -> None:
        self._update_times_us.append(update_time_us)
        if len(self._update_times_us) == TIMING_BATCH:
            self._publish_timing(step)

    def _publish_timing(self, step: int) -> None:
        times = ' '.join(f'{value:.3f}' for value in self._update_times_us)
        self._update_times_us = []
        pairs = [('update_times_us', times)]
        self._timing.publish(status_message(stamp_of_step(step), self.get_name(), pairs))

    def _declare_gains(self) -> None:
        for name, value in self._controller.gains().items():
            declare(self, f'gains.{name}', value, _ABOUT_GAINS, read_only=False)
            self._controller.set_gain(name, self.get_parameter(f'gains.{name}').value)
        self.add_on_set_parameters_callback(self._set_gains)

    def _set_gains(self, parameters: list[Parameter]) -> SetParametersResult:
        before = self._controller.gains()
        try:
            for parameter in parameters:
                if parameter.name.startswith('gains.'):
                    name = parameter.name.removeprefix('gains.')
                    self._controller.set_gain(name, parameter.value)
        except ParameterError as error:
            for name, value in before.items():
                self._controller.set_gain(name, value)
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('controller', ControllerNode)


if __name__ == '__main__':
    raise SystemExit(main())
