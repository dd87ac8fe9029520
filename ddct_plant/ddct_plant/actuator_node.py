"""Node `actuator`: turns each torque request into the torque over the coming period."""

from typing import Any, ClassVar

from geometry_msgs.msg import WrenchStamped
from rosgraph_msgs.msg import Clock
from trajectory_msgs.msg import JointTrajectory

from ddct_plant.actuator import Actuator
from ddct_plant.errors import DdctError
from ddct_plant.fail_safe import FailSafe, FailSafeSettings
from ddct_plant.graph.arrivals import read_torque
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.messages import TorquePointsMessage, stamp_ns
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.settings import declare, declare_request_timeout
from ddct_plant.graph.spin import run_node
from ddct_plant.initial import initial_state
from ddct_plant.timebase import step_of_stamp


class ActuatorNode(FollowerNode):
    """
    Answer `clutch/torque_request` with `actuator/torque`.

    In real time it also follows `/clock`: a request that is missing is held for
    `request_timeout_s`, then the clutch opens at `fail_safe_ramp_n_m_s`. Until it hears
    `/clock` it gives no torque, and it ends when requests go on without: it could not tell that
    they stop.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p fail_safe_ramp_n_m_s:=500.0',)

    def __init__(self, **kwargs: Any) -> None:
        """Build the actuator at rest on the run's first request."""
        super().__init__('actuator', **kwargs)
        self._held_request = initial_state(self.settings).torque_request
        self._actuator = Actuator(self._held_request)
        self._next_step = 0
        self._torque = self.create_publisher(JointTrajectory, 'actuator/torque', LOOP_QOS)
        self._message = TorquePointsMessage()
        fail_safe = self._declare_fail_safe()
        self._fail_safe = FailSafe(fail_safe)
        self._clock_heard = False
        self._first_step: int | None = None
        self.publish_run_info(fail_safe.info())
        self.follow([(WrenchStamped, 'clutch/torque_request')])
        if not self.settings.lockstep:
            self.create_subscription(Clock, '/clock', self.guarded(self._on_clock), LOOP_QOS)

    def _declare_fail_safe(self) -> FailSafeSettings:
        return FailSafeSettings(
            declare_request_timeout(self, 'the clutch opens'),
            declare(
                self,
                'fail_safe_ramp_n_m_s',
                FailSafeSettings.fail_safe_ramp_n_m_s,
                'Rate at which it opens [N m/s]',
            ),
        )

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the torque over the period of step k, after any steps that had no request."""
        request = read_torque('clutch/torque_request', inputs['clutch/torque_request'])
        self._require_clock(step)
        if self._fail_safe.engaged or step < self._next_step:
            return ()
        self._catch_up(step)
        self._fail_safe.request(step, request)
        self._held_request = request
        return self._advance(stamp_ns, request)

    def publish_reply(self) -> None:
        """Publish the torque, in real time once the fail-safe sees the time pass."""
        if self._clock_heard or self.settings.lockstep:
            super().publish_reply()

    def _require_clock(self, step: int) -> None:
        if self._clock_heard or self.settings.lockstep:
            return
        if self._first_step is None:
            self._first_step = step
        if self._fail_safe.watch.too_long(self._first_step, step):
            raise DdctError(
                'clutch/torque_request comes without /clock, by which the fail-safe sees that '
                'requests stop: publish /clock (rosgraph_msgs/Clock) with the stamp of every tick'
            )

    def _on_clock(self, message: Clock) -> None:
        self._clock_heard = True
        stamp = stamp_ns(message)
        step = step_of_stamp(stamp)
        was_engaged = self._fail_safe.engaged
        if not self._fail_safe.tick(step) or step < self._next_step:
            return
        if not was_engaged:
            self.get_logger().error(
                f'no clutch/torque_request before stamp {stamp} ns: opening the clutch'
            )
        self._catch_up(step, ramping=was_engaged)
        self._held_request = self._fail_safe.next_torque()
        for publisher, torque in self._advance(stamp, self._held_request):
            publisher.publish(torque)

    def _catch_up(self, step: int, *, ramping: bool = False) -> None:
        for _ in range(self._next_step, step):
            if ramping:
                self._held_request = self._fail_safe.next_torque()
            self._actuator.update(self._held_request)
        self._next_step = step

    def _advance(self, stamp: int, request: float) -> Reply:
        self._next_step += 1
        return ((self._torque, self._message.fill(stamp, self._actuator.update(request))),)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('actuator', ActuatorNode)


if __name__ == '__main__':
    raise SystemExit(main())
