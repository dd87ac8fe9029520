"""Node `driveline`: owns time, integrates the stiff states and publishes them at every tick."""

from collections.abc import Callable
from typing import Any, ClassVar

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import AccelStamped, TwistStamped, WrenchStamped
from rclpy.clock import Clock, ClockType
from rosgraph_msgs.msg import Clock as ClockMsg
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from trajectory_msgs.msg import JointTrajectory

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S, stamp_of_step, steps_in
from ddct_plant.fail_safe.driveline_info import driveline_info
from ddct_plant.fail_safe.request_watch import CLUTCH_TIMEOUT_S, FailSafeSettings
from ddct_plant.graph.arrivals import read_torque, read_torque_points
from ddct_plant.graph.messages import (
    accel_message,
    clock_message,
    joint_states_message,
    slip_message,
    stamp_ns,
    status_message,
    twist_message,
)
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.refusals import Refusals
from ddct_plant.graph.safe_state import SafeStateReport
from ddct_plant.graph.settings import declare, declare_fail_safe_ramp, declare_timeout
from ddct_plant.graph.sole_publishers import SolePublishers
from ddct_plant.graph.spin import run_node
from ddct_plant.models.driveline import Driveline
from ddct_plant.scenario.initial import initial_state
from ddct_plant.ticks.realtime_owner import RealtimeOwner
from ddct_plant.ticks.tick_owner import (
    CLUTCH,
    ENGINE,
    LOAD,
    RECORDER_TOPIC,
    LockstepOwner,
    TickPlan,
)

_STEADY = Clock(clock_type=ClockType.STEADY_TIME)
WATCH_PERIOD_S = 0.02
"""How often an unanswered tick is looked at."""


class _Output:
    """A publisher with the one message that it sends again and again."""

    def __init__(self, node: GraphNode, kind: type, topic: str, make: Callable[..., Any]) -> None:
        self._publisher = node.create_publisher(kind, topic, LOOP_QOS)
        self._make = make
        self._message: Any = None

    def publish(self, stamp: int, *values: Any) -> None:
        self._message = self._make(stamp, *values, reuse=self._message)
        self._publisher.publish(self._message)


class DrivelineNode(GraphNode):
    """
    Publish the tick t_k, wait for the torques (and the recorder), step, publish t_k+1.

    In real time it steps on a steady 10 ms timer instead and counts what is missing; a bad torque
    counts as a missing one. When `clutch/torque` stays away for `clutch_timeout_s`, the held
    torque runs to zero at `fail_safe_ramp_n_m_s` and counts no more when it comes back.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p require_recorder:=true -p duration:=2.0',)

    def __init__(self, **kwargs: Any) -> None:
        """Build the driveline in its initial state; `begin` starts the run."""
        super().__init__('driveline', **kwargs)
        scenario = self.settings.scenario
        self.plan = self._declare_plan()
        self.driveline = Driveline(
            scenario.driveline, scenario.vehicle, initial_state(self.settings)
        )
        self._sole_publishers = SolePublishers(self, lambda: self._publish_tick(self.plan.steps))
        self.owner = self._make_owner()
        self.refusals = Refusals(self)
        self._create_publishers()
        self._subscribe(WrenchStamped, ENGINE, lambda m: read_torque(ENGINE, m))
        self._subscribe(WrenchStamped, LOAD, lambda m: read_torque(LOAD, m))
        self._subscribe(JointTrajectory, CLUTCH, lambda m: read_torque_points(CLUTCH, m))
        if self.plan.require_recorder:
            self._subscribe(Header, RECORDER_TOPIC, lambda m: m)
        self.publish_run_info(driveline_info(self.plan.steps, self.plan.clutch))
        self._start_timers()

    def close(self) -> None:
        """Stop looking at the graph."""
        self._sole_publishers.close()

    def _declare_plan(self) -> TickPlan:
        duration_s = declare(
            self, 'duration', 0.0, "Length of the run [s]; 0 is the scenario's", 0.0, 3600.0
        )
        return TickPlan(
            steps=steps_in('duration', duration_s) or self.settings.scenario.steps,
            require_recorder=declare(
                self, 'require_recorder', False, 'Whether each tick waits for recorder/ack'
            ),
            answer_timeout_s=declare(
                self, 'answer_timeout_s', 60.0, 'Wall time to wait for a reply [s]', 0.1, 3600.0
            ),
            clutch=FailSafeSettings(
                declare_timeout(
                    self,
                    'clutch_timeout_s',
                    CLUTCH_TIMEOUT_S,
                    'Real time: when clutch/torque stays away for longer [s], the clutch opens; '
                    'give more than request_timeout_s of actuator',
                ),
                declare_fail_safe_ramp(self),
            ),
        )

    def _make_owner(self) -> LockstepOwner | RealtimeOwner:
        if self.settings.lockstep:
            return LockstepOwner(
                self.driveline, self.plan, self._publish_tick, self._sole_publishers.finish
            )
        owner = RealtimeOwner(
            self.driveline,
            self.plan,
            self._publish_tick,
            self._sole_publishers.finish,
            on_started=lambda: self._start_ticks(owner),
        )
        return owner

    def _start_ticks(self, owner: RealtimeOwner) -> None:
        self.create_timer(PERIOD_S, self.guarded(owner.tick), clock=_STEADY)

    def _create_publishers(self) -> None:
        self._clock_out = _Output(self, ClockMsg, '/clock', clock_message)
        self._slip_out = _Output(self, TwistStamped, 'clutch/slip', slip_message)
        self._joints_out = _Output(
            self, JointState, 'driveline/joint_states', joint_states_message
        )
        self._twist_out = _Output(self, TwistStamped, 'vehicle/twist', twist_message)
        self._accel_out = _Output(self, AccelStamped, 'vehicle/accel', accel_message)
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', LOOP_QOS)
        self._safe_state = SafeStateReport(self)

    def _subscribe(self, message_type: type, topic: str, read: Callable[[Any], Any]) -> None:
        def receive(message: Any) -> None:
            if topic == CLUTCH and self._sole_publishers.found:
                return  # whose torque it is cannot be told: without it the clutch opens
            stamp = stamp_ns(message)
            try:
                reply = read(message)
            except DdctError as error:
                self._on_bad_values(DdctError(f'at stamp {stamp} ns: {error}'))
                return
            self.owner.offer(topic, stamp, reply)

        self.create_subscription(message_type, topic, self.guarded(receive), LOOP_QOS)

    def _on_bad_values(self, error: DdctError) -> None:
        if self.settings.lockstep:
            raise error
        self.refusals.add(str(error))

    def _start_timers(self) -> None:
        self._start_timer = self.create_timer(0.0, self.guarded(self._begin), clock=_STEADY)
        self.create_timer(WATCH_PERIOD_S, self.guarded(self.owner.watch), clock=_STEADY)

    def _begin(self) -> None:
        self._start_timer.cancel()
        self.owner.start()

    def _publish_tick(self, step: int) -> None:
        stamp = stamp_of_step(step)
        now = self.driveline.outputs()
        self._clock_out.publish(stamp)
        self._slip_out.publish(stamp, now.slip_speed)
        self._joints_out.publish(stamp, now.positions, now.speeds, now.efforts)
        self._twist_out.publish(stamp, now.vehicle_speed)
        self._accel_out.publish(stamp, now.vehicle_accel)
        if isinstance(self.owner, RealtimeOwner) and self.owner.safe:
            why = f'no {CLUTCH} for longer than clutch_timeout_s: opening the clutch'
            self._safe_state.tell(step, stamp, why)
        if step % STEPS_PER_S == 0 or step == self.plan.steps:
            self._diagnostics.publish(status_message(stamp, 'driveline: ticks', self._counts()))

    def _counts(self) -> list[tuple[str, str]]:
        owner = self.owner
        pairs = [
            ('steps', str(owner.step)),
            ('resends', str(owner.resends)),
            ('missed_steps', str(owner.missed_steps)),
            ('late_messages', str(owner.barrier.late)),
        ]
        if isinstance(owner, RealtimeOwner):
            pairs += [(f'missed {topic}', str(n)) for topic, n in owner.missed_replies.items()]
            pairs.append(('worst_tick_lateness_us', f'{1e6 * owner.worst_lateness_s:.0f}'))
        return pairs


def main() -> int:
    """Run the node until the run is over or it is stopped."""
    return run_node('driveline', DrivelineNode)


if __name__ == '__main__':
    raise SystemExit(main())
