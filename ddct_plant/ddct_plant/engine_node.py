"""Node `engine`: the driver's demand and the delivered engine torque at every tick."""

from typing import Any, ClassVar

from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

from ddct_plant.engine import Engine
from ddct_plant.engine_info import engine_info
from ddct_plant.errors import DdctError
from ddct_plant.fail_safe import RequestWatch
from ddct_plant.graph.arrivals import read_torque
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.messages import stamp_ns, torque_message
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.settings import declare, declare_request_timeout
from ddct_plant.graph.spin import run_node
from ddct_plant.timebase import step_of_stamp

JOINT_STATES = 'driveline/joint_states'
REQUEST = 'engine/torque_request'


class EngineNode(FollowerNode):
    """
    Answer `driveline/joint_states` with `engine/torque_demand` and `engine/torque`.

    With `two_input` the demand is answered at once, and `engine/torque` once the controller's
    `engine/torque_request` of that stamp is here. In real time, when requests stop for
    `request_timeout_s`, the engine goes back to the demand as fast as its authority lets it, and
    stays there until it is started again: the actuator has opened the clutch by then.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p two_input:=true',)

    def __init__(self, **kwargs: Any) -> None:
        """Build the engine of the run's scenario."""
        super().__init__('engine', **kwargs)
        self._two_input = declare(
            self, 'two_input', False, 'Wait for engine/torque_request of a two-input controller'
        )
        scenario = self.settings.scenario
        self._engine = Engine(scenario.engine, scenario.engine_authority)
        timeout_s = declare_request_timeout(self, "the driver's demand takes over")
        self._watch = RequestWatch(timeout_s)
        self._alone_step = -1
        self._alone_torque = 0.0
        self._demand = self.create_publisher(WrenchStamped, 'engine/torque_demand', LOOP_QOS)
        self._torque = self.create_publisher(WrenchStamped, 'engine/torque', LOOP_QOS)
        self._demand_message = WrenchStamped()
        self._torque_message = WrenchStamped()
        self.publish_run_info(engine_info(self._two_input, timeout_s))
        if self._two_input:
            self.create_subscription(
                JointState, JOINT_STATES, self.guarded(self._publish_demand), LOOP_QOS
            )
            self.follow([(JointState, JOINT_STATES), (WrenchStamped, REQUEST)])
        else:
            self.create_subscription(
                WrenchStamped, REQUEST, self.guarded(self._refuse_request), LOOP_QOS
            )
            self.follow([(JointState, JOINT_STATES)])

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the torque over the period of step k, and the demand if it is not out yet."""
        if self._two_input:
            request = read_torque(REQUEST, inputs[REQUEST])
            self._watch.request(step)
            if self._watch.stopped or step <= self._alone_step:
                return ()  # too late: the demand has taken over, or answered this step
            return (self._delivered(stamp_ns, self._engine.torque(step, request)),)
        return (
            self._delivered(stamp_ns, self._engine.torque(step)),
            (self._demand, self._demand_at(step, stamp_ns)),
        )

    def _publish_demand(self, message: JointState) -> None:
        stamp = stamp_ns(message)
        step = step_of_stamp(stamp)
        self._demand.publish(self._demand_at(step, stamp))
        if not self.settings.lockstep and self._without_request(step, stamp):
            self._answer_alone(step, stamp)

    def _without_request(self, step: int, stamp: int) -> bool:
        """Say whether this step is answered alone: requests have stopped, or not begun yet."""
        if not self._watch.heard:
            return self._watch.too_long(0, step)
        took_over_before = self._watch.stopped
        if self._watch.tick(step) and not took_over_before:
            self.get_logger().error(
                f'no {REQUEST} before stamp {stamp} ns: the demand holds until the engine is '
                'started again'
            )
        return self._watch.stopped

    def _answer_alone(self, step: int, stamp: int) -> None:
        """Publish the torque without a request; a tick that comes again gets the same one."""
        if step > self._alone_step:
            self._alone_step = step
            self._alone_torque = self._engine.torque(step, self._engine.demand(step))
        self._torque.publish(self._delivered(stamp, self._alone_torque)[1])

    def _refuse_request(self, _message: WrenchStamped) -> None:
        raise DdctError(
            f'{REQUEST} arrived, but this engine follows the demand alone: start it with '
            '--ros-args -p two_input:=true, or choose a controller with one input'
        )

    def _delivered(self, stamp: int, torque: float) -> tuple[Any, WrenchStamped]:
        return self._torque, torque_message(stamp, torque, reuse=self._torque_message)

    def _demand_at(self, step: int, stamp: int) -> WrenchStamped:
        return torque_message(stamp, self._engine.demand(step), reuse=self._demand_message)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('engine', EngineNode)


if __name__ == '__main__':
    raise SystemExit(main())
