# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two live publishers of one topic of the loop end the run, and both are named."""

import itertools
from typing import Any

import pytest
from rclpy.node import Node
from samples import sampled
from support.altering import Repeating, add_altering
from support.in_process_graph import GraphOf, InProcessGraph
from support.processes import Programs
from support.runs import expected, plan
from support.second_publishers import LOOP, REPEAT_S, require_named_copy, require_named_echo

from ddct_bringup.bag.reader import read_bag
from ddct_plant.base.timebase import LONGEST_S, PERIOD_S
from ddct_plant.graph import sole_publishers
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    CLOCK,
    CLUTCH_TORQUE,
    ENGINE_REQUEST,
    ENGINE_TORQUE,
    LOAD_TORQUE,
    OFF_GOING_CLUTCH_TORQUE,
    RECORDER_ACK,
    SENSED_SLIP,
    VEHICLE_ACCEL,
)
from ddct_plant.ticks.realtime_owner import RealtimeOwner

ECHOED = [
    *(CLOCK, ENGINE_TORQUE, CLUTCH_TORQUE, RECORDER_ACK),
    *(ENGINE_REQUEST, SENSED_SLIP, OFF_GOING_CLUTCH_TORQUE),
]
"""A tick, replies with and without a recorder, and a topic of each other kind of run."""
COPIED = ['controller', 'off_going/actuator']
FROM_STEP = 20


def _clutch_torque(graph: InProcessGraph) -> float:
    """Return the torque in N m that the driveline integrates last."""
    outputs = graph.driveline.driveline.outputs()
    assert isinstance(outputs, DrivelineOutputs)
    return outputs.joint_effort.primary_shaft


def test_the_publishers_of_every_topic_of_a_tick_are_checked(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    graph.add('driveline')
    assert sorted(graph.driveline._sole_publishers._topics) == sorted(topic.name for topic in LOOP)


@pytest.mark.parametrize('topic', ECHOED, ids=lambda topic: topic.name)
def test_a_second_publisher_of_any_loop_topic_ends_the_run_with_its_name(
    graph_of: GraphOf, topic: Topic
) -> None:
    require_named_echo(graph_of, topic)


def test_a_process_that_could_not_run_does_not_miss_the_second_publisher(
    graph_of: GraphOf,
) -> None:
    """Neither the minutes that pass nor the wait for the first tick count as proof."""
    topic = ENGINE_REQUEST
    graph = graph_of(plan('mpc4', duration_s=0.02))
    add_altering(graph, topic.name, Repeating(REPEAT_S), name='echo')
    graph.add('driveline', {'require_recorder': False, 'answer_timeout_s': LONGEST_S})
    graph.add('controller')
    graph.pass_time(1.5 * sole_publishers.CHECK_S)
    assert graph.time is not None
    for _ in range(int(1.5 * sole_publishers.PROOF_S / sole_publishers.CHECK_S)):
        graph.time.jump(60.0)
    graph.add_all(without=['recorder'])
    node, complaint = graph.first_failure()
    assert (node, complaint.partition(' has ')[0]) == ('driveline', topic.name)


@pytest.mark.parametrize(
    ('name', 'recorded'), sampled(itertools.product(COPIED, [True, False]), every=3)
)
def test_a_second_copy_of_any_node_ends_the_run_with_its_name(
    graph_of: GraphOf, name: str, recorded: bool
) -> None:
    require_named_copy(graph_of, name, recorded=recorded)


@pytest.mark.parametrize(
    ('name', 'changes'),
    sampled([('controller', {'controller': 'pi'}), ('load', {}), ('clutch', {})], every=3),
)
def test_in_real_time_a_second_publisher_opens_the_clutch_before_it_is_named(
    graph_of: GraphOf, name: str, changes: dict[str, str], capfd: pytest.CaptureFixture[str]
) -> None:
    graph = graph_of(plan('ls8', mode='realtime', duration_s=60.0))
    graph.add_all()
    graph.spin_until(lambda: _clutch_torque(graph) > 10.0, 'a clutch that transmits')
    rename = ['--ros-args', '-r', f'{name}:__node:=other', '-r', 'run_info:=other_info']
    graph.add(name, changes, key='second', cli_args=rename)
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert f' has two live publishers, of the nodes /{name} and /other' in complaint
    assert abs(_clutch_torque(graph)) < 1e-6
    (logged,) = [line for line in capfd.readouterr().err.splitlines() if 'two live' in line]
    assert '[ERROR]' in logged and logged.endswith(': opening the clutch')


def test_a_killed_node_that_is_still_in_the_graph_is_no_second_publisher(
    graph_of: GraphOf, programs: Programs
) -> None:
    run = plan(duration_s=0.3)
    graph = graph_of(run)
    load = programs.start_node('ddct_plant.nodes.load_node', graph.parameters_of('load'))
    graph.wait_for_publishers('load/torque')
    load.process.kill()
    load.wait()
    graph.add_all()
    graph.run()
    assert graph.nodes['driveline'].count_publishers('load/torque') == 2, 'it was forgotten'
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()


@pytest.mark.parametrize('away_s', sampled([0.03, 1.5, 4.9], every=2))
def test_a_node_that_is_killed_and_started_again_in_real_time_is_no_second_publisher(
    graph_of: GraphOf, away_s: float
) -> None:
    """It answers again, though the graph lists it twice, and the run goes on to its end."""
    run = plan(mode='realtime', duration_s=away_s + 2.0)
    graph = graph_of(run)
    graph.add_all()
    owner = graph.driveline.owner
    assert isinstance(owner, RealtimeOwner)
    graph.spin_until(lambda: owner.step >= FROM_STEP and not owner.missing(), 'a whole tick')
    graph.kill('load')
    graph.pass_time(away_s)
    missed = owner.missed_replies[LOAD_TORQUE.name]
    graph.add('load')
    graph.run()
    assert graph.driveline.count_publishers(LOAD_TORQUE.name) == 2, 'it was forgotten'
    assert missed == pytest.approx(away_s / PERIOD_S, abs=2)
    assert owner.missed_replies[LOAD_TORQUE.name] <= missed + 2
    assert (owner.step, owner.safe_clutches) == (run.steps, [])


def test_a_driveline_that_is_closed_in_doubt_ends_its_check_quietly(graph_of: GraphOf) -> None:
    """In one process its timers run on, while the other nodes are closed."""
    graph = graph_of(plan())
    stranger = Node('stranger', context=graph.context)
    graph.add_other(stranger)
    stranger.create_publisher(VEHICLE_ACCEL.message_class, VEHICLE_ACCEL.name, RECORDER_QOS)
    graph.add_all(without=['load'])
    graph.pass_time(1.5 * sole_publishers.CHECK_S)
    check: Any = graph.driveline._sole_publishers
    assert check._in_doubt()
    graph.driveline.close()
    assert not check._in_doubt() and graph.time is not None
    graph.time.advance(3.0 * sole_publishers.CHECK_S)
    assert not graph.driveline.done.done()
