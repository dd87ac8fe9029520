# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A process of a node that is stopped for a while or for good, or started again.

No claim is about how fast the machine is: what the driveline counts says when a test goes on.
"""

import signal
from functools import partial

import pytest
from support.in_process_graph import GraphOf, InProcessGraph
from support.processes import Program, Programs
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.graph.sole_publishers import PROOF_S
from ddct_plant.graph.steady_time import SteadyTime
from ddct_plant.signals.topics import CLUTCH_TORQUE, LOAD_TORQUE
from ddct_plant.ticks.realtime_owner import RealtimeOwner

PATIENCE_S = 3600.0
"""Time in s that the driveline waits for an answer, by a clock that the test puts forward."""


class AdvancedTime(SteadyTime):
    """The steady clock of the machine, put forward by a test."""

    ahead_s = 0.0

    def monotonic_ns(self) -> int:
        """Return the time in ns."""
        return super().monotonic_ns() + round(1e9 * self.ahead_s)


def _start_clutch(graph: InProcessGraph, programs: Programs) -> Program:
    """Start the clutch as a process of its own."""
    clutch = programs.start_node('ddct_plant.nodes.clutch_node', graph.parameters_of('clutch'))
    graph.wait_for_publishers(CLUTCH_TORQUE.name)
    return clutch


def _stop_at_step_80(graph: InProcessGraph, clutch: Program) -> None:
    """Stop the process of the clutch at step 80, until a tick was sent in vain."""
    owner = graph.driveline.owner
    graph.spin_until(lambda: owner.step >= 80, 'step 80')
    clutch.send(signal.SIGSTOP)
    resends = owner.resends
    graph.spin_until(lambda: owner.resends >= resends + 3, 'a tick sent again')
    assert CLUTCH_TORQUE.name in owner.missing()


def test_a_node_that_was_stopped_for_a_while_changes_no_bit(
    graph_of: GraphOf, programs: Programs
) -> None:
    run = plan(duration_s=2.0)
    graph = graph_of(run, wall_clock=True)
    clutch = _start_clutch(graph, programs)
    graph.add_all(without=['clutch'])
    _stop_at_step_80(graph, clutch)
    clutch.send(signal.SIGCONT)
    graph.run()
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()


def test_a_process_that_hangs_ends_the_run_at_its_step(
    graph_of: GraphOf, programs: Programs
) -> None:
    graph = graph_of(plan(duration_s=600.0), wall_clock=True)
    graph.parameters['driveline']['answer_timeout_s'] = PATIENCE_S
    clutch = _start_clutch(graph, programs)
    time = AdvancedTime()
    graph.add('driveline', {'require_recorder': False}, steady_time=time)
    graph.add_all(without=['clutch', 'recorder'])
    _stop_at_step_80(graph, clutch)
    step = graph.driveline.owner.step
    time.ahead_s = PATIENCE_S
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert complaint.startswith(f'no clutch/torque for stamp {10**9 + step * 10**7} ns')
    assert f'within {PATIENCE_S:g} s' in complaint


@pytest.mark.parametrize(
    ('name', 'topic'), [('load', LOAD_TORQUE.name), ('clutch', CLUTCH_TORQUE.name)]
)
def test_a_node_that_was_stopped_in_real_time_answers_again_when_it_goes_on(
    graph_of: GraphOf, programs: Programs, name: str, topic: str
) -> None:
    graph = graph_of(plan(mode='realtime', duration_s=600.0), wall_clock=True)
    node = programs.start_node(f'ddct_plant.nodes.{name}_node', graph.parameters_of(name))
    graph.wait_for_publishers(topic)
    graph.add_all(without=[name])
    owner = graph.driveline.owner
    assert isinstance(owner, RealtimeOwner)

    def reached(step: int) -> bool:
        return owner.step >= step

    def answered(missed: int, start: int) -> bool:
        """Return whether a step since then was not missed."""
        return owner.missed_replies[topic] - missed < owner.step - start

    for _ in range(2):
        start = owner.step
        graph.spin_until(partial(reached, start + 50), 'half a second')
        node.send(signal.SIGSTOP)
        graph.spin_until(partial(reached, start + 100), 'half a second more')
        node.send(signal.SIGCONT)
        so_far = owner.missed_replies[topic], owner.step
        graph.spin_until(partial(answered, *so_far), f'{topic} in time once more')


def test_a_node_that_is_killed_and_started_again_answers_and_is_no_second_publisher(
    graph_of: GraphOf, programs: Programs
) -> None:
    graph = graph_of(plan(mode='realtime', duration_s=600.0), wall_clock=True)
    load = programs.start_node('ddct_plant.nodes.load_node', graph.parameters_of('load'))
    graph.wait_for_publishers(LOAD_TORQUE.name)
    graph.add_all(without=['load'])
    owner = graph.driveline.owner
    assert isinstance(owner, RealtimeOwner)
    graph.spin_until(lambda: owner.step >= 50, 'half a second')
    load.process.kill()
    load.wait()
    programs.start_node('ddct_plant.nodes.load_node', graph.parameters_of('load'))
    listed = graph.driveline.count_publishers
    graph.spin_until(lambda: listed(LOAD_TORQUE.name) == 2, 'the killed load and the new one')
    missed, start = owner.missed_replies[LOAD_TORQUE.name], owner.step
    graph.spin_until(
        lambda: owner.missed_replies[LOAD_TORQUE.name] - missed < owner.step - start,
        'the load in time once more',
    )
    checked = owner.step + round(2.0 * PROOF_S / PERIOD_S)
    graph.spin_until(lambda: owner.step >= checked, 'a proof of two')
    assert listed(LOAD_TORQUE.name) == 2, 'it was forgotten'
