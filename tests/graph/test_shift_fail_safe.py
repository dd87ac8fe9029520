# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A shift in real time whose handover ends: both clutches open, so that no tie-up lasts."""

from support.in_process_graph import GraphOf
from support.runs import plan

from ddct_bringup.bag.reader import read_bag
from ddct_controllers.handover.handover_node import HandoverNode
from ddct_plant.base.timebase import PERIOD_S, stamp_of_step
from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S
from ddct_plant.signals.topics import CLUTCH_TORQUE, OFF_GOING_CLUTCH_TORQUE

SILENT_AT_STEP = 80
"""Step in the middle of the handover, which takes a second."""
HELD_STEPS = round(REQUEST_TIMEOUT_S / PERIOD_S)
OPEN_STEPS = 30
"""Ramp of less than 200 N m, delay and lag of the actuator."""


def test_without_its_handover_a_shift_opens_both_clutches_and_no_tie_up_lasts(
    graph_of: GraphOf,
) -> None:
    run = plan(
        'pi',
        scenario='upshift',
        duration_s=1.6,
        mode='realtime',
        handover='timed',
        changes=('shift.handover_s=1.0',),
    )
    graph = graph_of(run)
    graph.add_all()
    assert graph.driveline.plan.clutches == (CLUTCH_TORQUE.name, OFF_GOING_CLUTCH_TORQUE.name)
    owner = graph.driveline.owner
    graph.spin_until(lambda: owner.step == SILENT_AT_STEP, 'the handover of the torque')
    handover = graph.nodes['handover']
    assert isinstance(handover, HandoverNode)
    silent_from = handover.join.last_step + 1
    graph.remove('handover')
    graph.run()

    recording = read_bag(graph.folder)
    safe = recording.realtime.safe_states
    assert set(safe) == {'/actuator', '/off_going/actuator', '/engine'}
    assert set(safe.values()) == {stamp_of_step(silent_from + HELD_STEPS)}
    trajectory = recording.trajectory
    phases = trajectory.clutch_phase, trajectory.off_going_clutch_phase
    assert all(phase[silent_from] > 0.0 for phase in phases), 'both carry torque'
    assert not any(phase[silent_from + HELD_STEPS + OPEN_STEPS :].any() for phase in phases)
