# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `engine`: the driver's demand and the delivered engine torque at every tick."""

from typing import Any, ClassVar

from ddct_plant.base.errors import DdctError
from ddct_plant.base.options import Option
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.fail_safe.guarded import GuardedEngine
from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node_reports import engine_info
from ddct_plant.graph.output import Output, SafeStateReport
from ddct_plant.graph.settings import declare, declare_timeout
from ddct_plant.graph.spin import run_node
from ddct_plant.scenario.plant import make_engine, torque_estimate
from ddct_plant.signals.topics import (
    ENGINE_REQUEST,
    ENGINE_SENSOR_STATUS,
    ENGINE_TORQUE,
    JOINT_STATES,
    SENSED_ENGINE_TORQUE,
    TORQUE_CUT,
    TORQUE_DEMAND,
)

REQUEST = ENGINE_REQUEST.name


class EngineNode(FollowerNode):
    """
    Answer `driveline/joint_states` with `engine/torque_demand` and `engine/torque`.

    In a run with sensors it also publishes `sensors/engine_torque`, the estimate of the latter.

    With `two_input` the demand is published at once, and `engine/torque` once the controller's
    `engine/torque_request` of that stamp has arrived. In a gear shift, without `two_input`, it
    waits for `engine/torque_cut` of the handover in the same way, and takes it off the demand. In
    real time, when requests or cuts stop for `request_timeout_s`, the engine returns to the demand
    as fast as its authority allows, and follows it until the node is started again: the actuators
    have opened the clutches by then.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p two_input:=true',)

    def __init__(self, **kwargs: Any) -> None:
        """Build the engine of the run's scenario."""
        super().__init__('engine', **kwargs)
        self._two_input = declare(
            self,
            'two_input',
            Option(False, 'wait for engine/torque_request of a two-input controller'),
        )
        cut = TORQUE_CUT if self.known.shift else None
        self._command = ENGINE_REQUEST if self._two_input else cut
        self._engine = make_engine(self.settings)
        timeout_s = declare_timeout(
            self,
            'request_timeout_s',
            REQUEST_TIMEOUT_S,
            "Real time: when requests, or torque cuts of a shift, stop for longer, the driver's "
            'demand takes over',
        )
        self._commanded = GuardedEngine(self._engine, timeout_s)
        self._demand = Output(self, TORQUE_DEMAND)
        self._torque = Output(self, ENGINE_TORQUE)
        self._estimate = torque_estimate(self.settings)
        if self._estimate is not None:
            self._estimated = [
                (Output(self, topic), [signal.name for signal in topic.signals])
                for topic in (SENSED_ENGINE_TORQUE, ENGINE_SENSOR_STATUS)
            ]
        self.publish_run_info(engine_info(self._two_input, timeout_s))
        readers = {JOINT_STATES: self._speed}
        if not self._two_input:
            self.subscribe_messages(ENGINE_REQUEST, self._refuse_request)
        if self._command is not None:
            self.subscribe_values(JOINT_STATES, self._on_tick, self._speed)
            self.follow(JOINT_STATES, self._command, readers=readers)
        else:
            self.follow(JOINT_STATES, readers=readers)
        if not self.known.lockstep:
            self._safe_state = SafeStateReport(self)

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the torque over the period of step k, and the demand unless published."""
        speed, demand = inputs[JOINT_STATES.name], self._engine.demand(step)
        if self._command is None:
            return (
                *self._delivered(step, stamp_ns, self._engine.torque(demand, speed=speed)),
                self._demand.fill(stamp_ns, demand),
            )
        command = inputs[self._command.name]
        self._commanded.speed = speed
        torque = self._commanded.request(step, command if self._two_input else demand - command)
        return () if torque is None else self._delivered(step, stamp_ns, torque)

    def _delivered(self, step: int, stamp: int, torque: float) -> Reply:
        """Return C_m over the period of step k, preceded by its estimate in a run with sensors."""
        delivered = self._torque.fill(stamp, torque)
        if self._estimate is None:
            return (delivered,)
        values = self._estimate.measure(step, torque).signals
        estimated = [
            output.fill(stamp, *[values[name] for name in names])
            for output, names in self._estimated
        ]
        return (*estimated, delivered)

    def _speed(self, message: Any) -> float:
        """Return w_m in rad/s for an engine with limits, else 0 to save time."""
        limited = self.settings.scenario.engine_limits is not None
        return JOINT_STATES.read(message).engine if limited else 0.0

    def _on_tick(self, stamp: int, speed: float) -> None:
        step = step_of_stamp(stamp)
        self._demand.fill(stamp, self._engine.demand(step)).publish()
        if not self.known.lockstep:
            self._answer_alone(step, stamp, speed)

    def _answer_alone(self, step: int, stamp: int, speed: float) -> None:
        assert self._command is not None
        self._commanded.speed = speed
        torque = self._commanded.tick(step)
        if self._commanded.watch.stopped:
            self._safe_state.publish(
                step,
                stamp,
                f'no {self._command.name} for too long: the demand holds until the engine is '
                'started again',
            )
        if torque is not None:
            for output in self._delivered(step, stamp, torque):
                output.publish()

    def _refuse_request(self, _message: Any) -> None:
        raise DdctError(
            f'{REQUEST} arrived, but this engine follows the demand alone: start it with '
            '--ros-args -p two_input:=true, or choose a controller with one input'
        )


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('engine', EngineNode)


if __name__ == '__main__':
    raise SystemExit(main())
