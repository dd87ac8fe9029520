# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `controller`: runs the controller that its `controller` parameter names, every tick."""

import time
from dataclasses import replace
from typing import Any, ClassVar

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from ddct_controllers.architecture import make_architecture
from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.registry import controller_names, controller_spec, make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node_reports import controller_info, timing_pairs
from ddct_plant.graph.output import Output
from ddct_plant.graph.settings import declare
from ddct_plant.graph.spin import run_node
from ddct_plant.program.operating_system import end_at_exit
from ddct_plant.shift.balance import WHOLE
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    CONTROLLER_STATUS,
    CONTROLLER_TIMING,
    ENGINE_REQUEST,
    HANDOVER_SHARE,
    SLIP_REFERENCE,
    TORQUE_CUT,
    TORQUE_DEMAND,
    TORQUE_PARTS,
    TORQUE_REQUEST,
    measurement_topics,
)

TIMING_BATCH = 20
"""Number of steps whose update times are published together."""
_GAINS = 'gains.'
"""Prefix of the parameters that are the controller's options."""


class ControllerNode(FollowerNode):
    """
    Answer the measurements of a tick with `clutch/torque_request`, its parts and the status.

    In a run with sensors the measurements are those of the sensors. A controller with two inputs
    also answers with `engine/torque_request`, and takes the driver's demand in place of
    `engine/torque`, in a gear shift less `engine/torque_cut`. In a gear shift every controller
    waits for `clutch/handover_share`, carries that share of the open loop, and has feedback with
    the share 1. The options of the controller are parameters `gains.<name>`; its gains among them
    may be changed while it runs, which `controller/status` says from then on.
    """

    KNOWN_ONLY: ClassVar[bool] = True
    EXAMPLES: ClassVar[tuple[str, ...]] = (
        '-p controller:=ls8',
        '-p controller:=pi -p gains.proportional_gain:=0.2',
    )

    def __init__(self, **kwargs: Any) -> None:
        """Build the controller that the `controller` parameter names."""
        super().__init__('controller', **kwargs)
        name = declare(
            self, 'controller', Option('pi', f'one of: {", ".join(controller_names())}')
        )
        self._controller, info = self._make_controller(name)
        self._architecture = make_architecture(self.known, self._controller)
        self.add_on_set_parameters_callback(self._set_gains)
        self._measured_topics = measurement_topics(sensed=self.known.sensed)
        self._request = Output(self, TORQUE_REQUEST)
        if self._controller.commands_engine:
            self._engine_request = Output(self, ENGINE_REQUEST)
            self._engine_topic = TORQUE_DEMAND
        else:
            self._engine_topic = self._measured_topics.engine_torque
        self._parts = Output(self, TORQUE_PARTS)
        self._status = Output(self, CONTROLLER_STATUS)
        self._timing = Output(self, CONTROLLER_TIMING)
        self._update_times_us: list[float] = []
        self.publish_run_info(controller_info(info))
        self.follow(
            self._measured_topics.joint_states,
            self._measured_topics.vehicle_speed,
            self._engine_topic,
            SLIP_REFERENCE,
            *self._of_handover(),
            readers={SLIP_REFERENCE: self._read_reference},
        )

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the request for the period of step k and its parts."""
        measurement = self._measure(step, inputs)
        started = time.perf_counter()
        request = self._architecture.update(measurement, inputs.get(HANDOVER_SHARE.name, WHOLE))
        self._update_times_us.append(1e6 * (time.perf_counter() - started))
        if len(self._update_times_us) == TIMING_BATCH:
            self._publish_timing(step)
        reply = (
            self._request.fill(stamp_ns, request.torque),
            self._parts.fill(stamp_ns, *request.parts.values()),
            self._status.fill(stamp_ns, request.status),
        )
        if request.engine_torque is None:
            return reply
        return (self._engine_request.fill(stamp_ns, request.engine_torque), *reply)

    def close(self) -> None:
        """Publish the update times that are not in a batch yet."""
        if self._update_times_us:
            self._publish_timing(self.join.last_step)

    def _of_handover(self) -> tuple[Topic, ...]:
        """Return the topics of the handover that the controller reads in a gear shift."""
        if not self.known.shift:
            return ()
        commands_engine = self._controller.commands_engine
        return (HANDOVER_SHARE, TORQUE_CUT) if commands_engine else (HANDOVER_SHARE,)

    def _read_reference(self, message: Any) -> tuple[list[float], list[float]]:
        return SLIP_REFERENCE.read(message, preview_steps=self._controller.preview_steps)

    def _measure(self, step: int, inputs: dict[str, Any]) -> Measurement:
        joint_speed = inputs[self._measured_topics.joint_states.name]
        speeds, rates = inputs[SLIP_REFERENCE.name]
        return Measurement(
            step=step,
            engine_speed=joint_speed.engine,
            shaft_speed=joint_speed.primary_shaft,
            wheel_speed=joint_speed.wheel,
            vehicle_speed=inputs[self._measured_topics.vehicle_speed.name],
            engine_torque=inputs[self._engine_topic.name] - inputs.get(TORQUE_CUT.name, 0.0),
            slip_reference=speeds,
            slip_reference_rate=rates,
        )

    def _publish_timing(self, step: int) -> None:
        pairs = timing_pairs(self._update_times_us)
        self._update_times_us = []
        self._timing.fill(stamp_of_step(step), pairs).publish()

    def _make_controller(self, name: str) -> tuple[Controller, dict[str, str]]:
        """
        Build the controller, with its options declared as parameters `gains.<name>` first.

        Return its pairs for `run_info` too, with the options that differ from the scenario's.
        """
        spec = controller_spec(name)
        section = spec.values(self.known.scenario.controllers.get(spec.name, {}))
        options = spec.options or {}
        given = {
            key: self._declare_gain(key, replace(options[key], default=section[key]))
            for key in options
        }
        if spec.compiled:
            end_at_exit()  # the middleware's threads run on
        controller = make_controller(name, self.known, given)
        for key, value in controller.gains().items():
            if key not in given:
                about = Option(
                    value, 'its unit is in the documentation of the controller', live=True
                )
                controller.set_gain(key, self._declare_gain(key, about))
        others = {key: value for key, value in given.items() if value != section[key]}
        changed = {f'{_GAINS}{key}': repr(value) for key, value in others.items()}
        return controller, {**controller.info(spec.name), **changed}

    def _declare_gain(self, key: str, option: Option) -> Any:
        return declare(self, f'{_GAINS}{key}', option, read_only=not option.live)

    def _set_gains(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            if gains := {
                each.name.removeprefix(_GAINS): each.value
                for each in parameters
                if each.name.startswith(_GAINS)
            }:
                self._architecture.change_gains(gains)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('controller', ControllerNode)


if __name__ == '__main__':
    raise SystemExit(main())
