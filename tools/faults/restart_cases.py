# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes that end and are started again, at once and without their memory."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rosgraph_msgs.msg import Clock as ClockMessage
from support.in_process_graph import InProcessGraph

from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.signals.message_kind import stamp_ns
from faults.case import Case, Where, places
from faults.graph_runs import graph_run
from faults.outcome import NO_REPLY, RUNS_ON, SAME, Observed, Stated, either, named

AGAIN = either(RUNS_ON, named('carries two different messages'))
"""A node without memory that answers the stamp of its predecessor again may answer otherwise."""


RESTARTED: Where = {
    ('start', 'lockstep', 1): ('driveline',),
    ('middle', 'lockstep', 1): ('driveline', 'recorder', 'controller', 'actuator'),
    ('middle', 'lockstep', 2): ('handover',),
    ('start', 'realtime', 1): ('load',),
    ('middle', 'realtime', 1): ('driveline', 'recorder', 'actuator'),
}


class Restarter(Node):
    """Node that replaces another one of the graph at a step."""

    def __init__(self, graph: InProcessGraph, path: str, step: int) -> None:
        """Replace the node `path` at the first tick from `step` on."""
        super().__init__('restarter', context=graph.context)
        self._graph, self._path, self._step = graph, path, step
        self.create_subscription(ClockMessage, '/clock', self._on_clock, RECORDER_QOS)

    def _on_clock(self, message: ClockMessage) -> None:
        if self._step < 0 or step_of_stamp(stamp_ns(message)) < self._step:
            return
        self._step = -1
        # From a timer: nodes come and go between the callbacks of others.
        self._timer = self.create_timer(
            0.0, self._restart, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )

    def _restart(self) -> None:
        self._timer.cancel()
        self._graph.remove(self._path)
        self._graph.add(self._path)


def restart(path: str, case: Case, folder: Path) -> Observed:
    """Record a run in which a node is started again."""

    def arrange(graph: InProcessGraph) -> None:
        graph.add_other(Restarter(graph, path, case.begin))

    return graph_run(case, folder, arrange)


def cases() -> Iterator[Case]:
    """Yield each of the targets."""
    for path, instant, mode, clutches in places(RESTARTED):
        stated = _after_restart(path, instant, mode)
        yield Case(
            *('node restarted', path, instant, mode, clutches), stated, partial(restart, path)
        )


def _after_restart(path: str, instant: str, mode: str) -> Stated:
    missed = named('came where step')
    stated = missed if mode == 'lockstep' else AGAIN
    if path in ('driveline', 'recorder'):
        stated = either(missed, NO_REPLY, named('nothing was recorded'))
    elif mode == 'realtime' and path == 'actuator':
        # It ends when requests reach it earlier than ticks, for too long.
        stated = either(AGAIN, named('/clock'))
    # A driveline that is started again at once begins the run anew.
    anew = [RUNS_ON] if mode == 'realtime' else []
    return either(SAME, stated, *anew) if instant == 'start' else stated
