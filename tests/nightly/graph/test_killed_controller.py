# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time by the wall clock: the clutch opens when the process of a controller ends or stops."""

import signal

import pytest
from support.in_process_graph import GraphOf
from support.processes import Programs
from support.runs import plan

from ddct_bringup.bag.reader import read_bag

SILENT_AT_STEP = 80


@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGSTOP])
def test_the_clutch_is_open_at_the_end_of_a_run_whose_controller_was_killed_or_stopped(
    graph_of: GraphOf, programs: Programs, number: signal.Signals
) -> None:
    graph = graph_of(plan(mode='realtime', duration_s=3.0), wall_clock=True)
    shared = graph.parameters_of('controller')
    controller = programs.start_node('ddct_controllers.controller_node', shared)
    graph.wait_for_publishers('clutch/torque_request')
    graph.add_all(without=['controller'])
    owner = graph.driveline.owner
    graph.spin_until(lambda: owner.step >= SILENT_AT_STEP, f'step {SILENT_AT_STEP}')
    controller.send(number)
    # A stopped node does not acknowledge the last tick, for which no node of the run waits then.
    graph.run()
    controller.send(signal.SIGKILL)
    recording = read_bag(graph.folder)
    assert recording.realtime.safe_states
    assert abs(recording.trajectory.joint_effort[-1, 1]) < 1.0
