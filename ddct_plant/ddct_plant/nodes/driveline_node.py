# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `driveline`: owns time, integrates the stiff states and publishes them at every tick."""

from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from typing import Any, ClassVar

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S, stamp_of_step
from ddct_plant.graph.domain import sole_graph
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.node_names import StatusName
from ddct_plant.graph.node_reports import TICKS, TickCounts, driveline_info
from ddct_plant.graph.output import Output, SafeStateReport
from ddct_plant.graph.sole_publishers import SolePublishers
from ddct_plant.graph.spin import run_node
from ddct_plant.nodes.tick_plan import declare_tick_plan
from ddct_plant.program.supervision import is_supervised
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import driveline_sensors, make_driveline
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    CLOCK,
    CLUTCH_PHASE,
    CLUTCH_TORQUE,
    DIAGNOSTICS,
    ENGINE_TORQUE,
    HOLDING_TORQUE,
    JOINT_STATES,
    LOAD_TORQUE,
    OFF_GOING_CLUTCH_TORQUE,
    OFF_GOING_JOINT_STATES,
    OFF_GOING_PHASE,
    OFF_GOING_SLIP,
    RECORDER_ACK,
    SENSED_SLIP,
    SENSED_TOPICS,
    SLIP,
    VEHICLE_ACCEL,
    VEHICLE_SPEED,
)
from ddct_plant.ticks.realtime_owner import RealtimeOwner
from ddct_plant.ticks.tick_owner import TickOwner

CLUTCHES = (CLUTCH_TORQUE, OFF_GOING_CLUTCH_TORQUE)
"""Topics of the torques of the clutches, the off-going one in a gear shift only."""
TORQUES = (ENGINE_TORQUE, LOAD_TORQUE, HOLDING_TORQUE, *CLUTCHES)
"""Topics of the torques that the driveline integrates, in the order of its `step`."""
SENSED = sorted(
    (topic for topic in SENSED_TOPICS if topic.is_tick), key=lambda topic: topic is not SENSED_SLIP
)
"""Topics of a tick that carry measurements of the sensors and their flags, the slip first."""
TICK = (
    *(*SENSED, SLIP, OFF_GOING_SLIP, JOINT_STATES, CLUTCH_PHASE, OFF_GOING_PHASE),
    *(VEHICLE_SPEED, CLOCK, VEHICLE_ACCEL, OFF_GOING_JOINT_STATES),
)
"""Topics of a tick, in the order of publication: the slip has the longest way round the loop."""
WATCH_PERIOD_S = 0.02
"""Period in s at which an unanswered tick is checked."""


class DrivelineNode(GraphNode):
    """
    Publish the tick t_k, wait for the torques (and the recorder), step, publish t_k+1.

    In real time it steps on a steady 10 ms timer instead and counts missing replies; a bad torque
    counts as a missing one. When `clutch/torque` is missing for `clutch_timeout_s`, the held
    torque runs to zero at `fail_safe_ramp_n_m_s`, and later clutch torques are ignored. In a gear
    shift it also publishes the states of the off-going side, waits for `off_going/clutch/torque`,
    and treats it in the same way.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p require_recorder:=true -p duration:=2.0',)

    def __init__(self, *, keeps_graph: bool = False, **kwargs: Any) -> None:
        """
        Build the driveline in its initial state; a timer starts the run once the node spins.

        With `keeps_graph` no other graph may have its clock in its domain meanwhile, else the
        node ends with an error.
        """
        super().__init__('driveline', **kwargs)
        self._keeps_graph = keeps_graph
        self._kept = ExitStack()
        self._run = self.known.kind()
        self._torques = [topic for topic in TORQUES if topic.in_run(self._run)]
        self._clutches = [topic for topic in CLUTCHES if topic.in_run(self._run)]
        self.plan = declare_tick_plan(self, self._torques, self._clutches)
        self.driveline = make_driveline(self.settings, initial_state(self.settings))
        self._sensors = driveline_sensors(self.settings)
        self._sole_publishers = SolePublishers(self, lambda: self._publish_tick(self.owner.step))
        self.owner = self._make_owner()
        self._outputs = [
            (Output(self, topic), [signal.name for signal in topic.signals])
            for topic in TICK
            if topic.in_run(self._run)
        ]
        self._diagnostics = Output(self, DIAGNOSTICS)
        self._safe_state = SafeStateReport(self)
        self._subscribe_to_replies()
        self.publish_run_info(driveline_info(self.plan.steps, self.plan.fail_safe))
        self._start_timer = self.every(0.0, self._begin)
        self.every(WATCH_PERIOD_S, self.owner.watch)

    def close(self) -> None:
        """End the check for second publishers, and leave the clock of the domain to others."""
        self._sole_publishers.close()
        self._kept.close()

    def _make_owner(self) -> TickOwner:
        parts = (
            *(self.driveline.step, self.plan, self._publish_tick, self._sole_publishers.finish),
            self.steady_time.monotonic,
        )
        if self.known.lockstep:
            return TickOwner(*parts, over=self._engine_ends_run)
        owner = RealtimeOwner(
            *parts, over=self._engine_ends_run, on_started=lambda: self.every(PERIOD_S, owner.tick)
        )
        return owner

    def _engine_ends_run(self) -> bool:
        return bool(self.settings.scenario.end_cause(self.driveline.engine_speed))

    def _subscribe_to_replies(self) -> None:
        rows = len(CLUTCH_TORQUE.signals_in(self._run))
        acknowledged = (RECORDER_ACK,) if self.plan.recorder else ()
        for topic in self._torques:
            read = partial(topic.read, joints=rows) if topic in self._clutches else None
            self.subscribe_values(topic, partial(self._receive, topic), read)
        for topic in acknowledged:
            self.subscribe_values(topic, partial(self._receive, topic))
        clock = self.resolve_topic_name(CLOCK.name)
        longest = f'for at most {self.plan.answer_timeout_s:g} s (answer_timeout_s)'
        then = f' after each tick on {clock}, {longest}'
        self.log_start(*self._torques, *acknowledged, then=then)

    def _receive(self, topic: Topic, stamp: int, reply: Any) -> None:
        # With two publishers no clutch torque counts, so that the clutch opens.
        if topic not in self._clutches or not self._sole_publishers.found:
            self.owner.offer(topic.name, stamp, reply)

    def _begin(self) -> None:
        self._start_timer.cancel()
        if self._keeps_graph:
            domain, clock = self.context.get_domain_id(), self.resolve_topic_name(CLOCK.name)
            try:
                self._kept.enter_context(sole_graph(domain, clock))
            except DdctError as error:
                self.finish(error)
                return
        self.owner.start()

    def _publish_tick(self, step: int) -> None:
        stamp = stamp_of_step(step)
        outputs = self.driveline.outputs()
        values = outputs.signals
        if self._sensors:
            values |= self._sensors.measure(step, outputs).signals
        for output, names in self._outputs:
            output.fill(stamp, *[values[name] for name in names]).publish()
        if isinstance(self.owner, RealtimeOwner) and (missing := self.owner.safe_clutches):
            topics = ' and no '.join(missing)
            why = f'no {topics} for longer than clutch_timeout_s: opening the clutch'
            self._safe_state.publish(step, stamp, why)
        if step % STEPS_PER_S == 0 or step == self.owner.last_step:
            name = StatusName(self.get_fully_qualified_name(), TICKS)
            self._diagnostics.fill(stamp, self._counts().pairs(), name=str(name)).publish()

    def _counts(self) -> TickCounts:
        owner = self.owner
        counts = TickCounts(owner.step, owner.resends, owner.missed_steps, owner.late)
        if not isinstance(owner, RealtimeOwner):
            return counts
        lateness_s, latency_s = owner.durations.take()
        return replace(
            counts,
            missed_replies=owner.missed_replies,
            lateness_us=[1e6 * each for each in lateness_s],
            latency_us=[1e6 * each for each in latency_s],
        )


def main() -> int:
    """Run the node until the run is over or it is stopped."""
    # A supervisor has done so already for its graph.
    return run_node('driveline', partial(DrivelineNode, keeps_graph=not is_supervised()))


if __name__ == '__main__':
    raise SystemExit(main())
