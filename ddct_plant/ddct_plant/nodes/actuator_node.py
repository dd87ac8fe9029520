# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `actuator`: computes from each torque request the torque over the coming period."""

from typing import Any, ClassVar

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import START_NS
from ddct_plant.fail_safe.guarded import GuardedActuator
from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node_reports import actuator_info, role_info
from ddct_plant.graph.output import Output, SafeStateReport
from ddct_plant.graph.settings import declare_fail_safe, declare_role
from ddct_plant.graph.spin import run_node
from ddct_plant.scenario.initial_state import initial_request
from ddct_plant.scenario.plant import make_actuator
from ddct_plant.signals.topics import ACTUATOR_TORQUE, CLOCK, TORQUE_REQUEST

REQUEST = TORQUE_REQUEST.name


class ActuatorNode(FollowerNode):
    """
    Answer `clutch/torque_request` with `actuator/torque`.

    In a gear shift a second one, in a namespace of its own, has the `role` off_going.

    In real time it also follows `/clock`: the last request is held for `request_timeout_s` when
    requests stop, then the clutch opens at `fail_safe_ramp_n_m_s`. Until it receives `/clock` it
    publishes no torque, and it ends when requests go on without `/clock`: it could not detect
    that they stop.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p fail_safe_ramp_n_m_s:=500.0',)

    def __init__(self, **kwargs: Any) -> None:
        """Build the actuator in its steady state for the run's first request."""
        super().__init__('actuator', **kwargs)
        role = declare_role(self, self.known)
        fail_safe = declare_fail_safe(
            self,
            'request_timeout_s',
            REQUEST_TIMEOUT_S,
            'Real time: when requests stop for longer, the clutch opens',
        )
        first = initial_request(self.known, role)
        self._actuator = GuardedActuator(make_actuator(self.settings, first), first, fail_safe)
        self._torque = Output(self, ACTUATOR_TORQUE)
        self._request = self.shown(REQUEST)
        self._requests_without_clock = 0
        self.publish_run_info({**role_info(self.known, role), **actuator_info(fail_safe)})
        self.follow(TORQUE_REQUEST)
        if not self.known.lockstep:
            self._safe_state = SafeStateReport(self)

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the torque over the period of step k, after any steps that had no request."""
        torques = self._actuator.request(step, inputs[REQUEST])
        return () if torques is None else (self._torque.fill(stamp_ns, torques),)

    def publish_reply(self) -> None:
        """Publish the torque; in real time only after a tick, by which the fail-safe runs."""
        if self._has_ticks:
            super().publish_reply()

    def admits(self, topic: str, stamp: int) -> bool:
        """Return whether a stamp can be true; raise DdctError for requests without ticks."""
        if not self._has_ticks and topic != CLOCK.name and stamp > START_NS:
            self._requests_without_clock += 1
            if self._actuator.watch.too_long(0, self._requests_without_clock):
                clock = self.resolve_topic_name(CLOCK.name)
                raise DdctError(
                    f'at stamp {stamp} ns: {self._request} comes without {clock}, by '
                    f'which the fail-safe sees that requests stop: publish {clock} '
                    '(rosgraph_msgs/Clock) with the stamp of every tick'
                )
        return super().admits(topic, stamp)

    @property
    def _has_ticks(self) -> bool:
        return self.limit is None or self.limit.newest is not None

    def on_tick(self, step: int, stamp: int) -> None:
        """Open the clutch while requests have stopped."""
        torques = self._actuator.tick(step)
        if torques is None:
            return
        self._safe_state.publish(
            step, stamp, f'no {self._request} for too long: opening the clutch'
        )
        self._torque.fill(stamp, torques).publish()


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('actuator', ActuatorNode)


if __name__ == '__main__':
    raise SystemExit(main())
