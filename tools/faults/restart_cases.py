# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes that end and are started again, at once and without their memory."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

from support.in_process_graph import InProcessGraph

from faults.case import Case, Where, places
from faults.graph_runs import graph_run
from faults.outcome import NO_REPLY, RUNS_ON, SAME, Observed, Stated, either, named

AGAIN = either(RUNS_ON, named('carries two different messages'))
"""A node without memory that answers the stamp of its predecessor again may answer otherwise."""


AWAY_S = 0.3
"""Time in s that a node takes to start."""
RESTARTED: Where = {
    ('start', 'lockstep', 1): ('driveline',),
    ('middle', 'lockstep', 1): ('driveline', 'recorder', 'controller', 'actuator'),
    ('middle', 'lockstep', 2): ('handover',),
    ('start', 'realtime', 1): ('load',),
    ('middle', 'realtime', 1): ('driveline', 'recorder', 'actuator'),
}


def restart(path: str, case: Case, folder: Path) -> Observed:
    """Record a run in which a node is started again at a tick."""

    def again(graph: InProcessGraph) -> None:
        graph.remove(path)
        graph.pass_time(AWAY_S)
        graph.add(path)

    return graph_run(case, folder, act=again)


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
