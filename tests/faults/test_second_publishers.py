# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two live publishers of one topic of the loop end the run, and both are named."""

from typing import Any

import pytest
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from support.in_process_graph import GraphOf, InProcessGraph
from support.patient_clock import realtime_owner
from support.processes import START_S, Programs
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_plant.graph import sole_publishers
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.signals.signal import RunKind
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    ENGINE_REQUEST,
    OFF_GOING_CLUTCH_TORQUE,
    SHIFT_TOPICS,
    TOPICS,
    VEHICLE_ACCEL,
)

STALL_S = 0.03
"""Lateness, s, from which a request may be missing for longer than the actuator's timeout."""
LOOP = [topic for topic in TOPICS if topic.every_tick]
ECHOED = [topic for topic in LOOP if topic not in SHIFT_TOPICS] + [OFF_GOING_CLUTCH_TORQUE]
"""Topics of the loop of other runs, and one of a shift, where the check is the same."""
NODE_NAMES = [node.name for node in GRAPH_NODES]
COPIED = [*(name for name in NODE_NAMES if name != 'recorder'), 'handover', 'off_going/actuator']


class Echo(Node):
    """Node that publishes the last message of a topic repeatedly."""

    def __init__(self, topic: Topic, **options: Any) -> None:
        """Subscribe to `topic` and repeat it."""
        super().__init__('echo', **options)
        self._publisher = self.create_publisher(topic.message_class, topic.name, RECORDER_QOS)
        self._last: bytes | None = None
        self.create_subscription(
            topic.message_class, topic.name, self._keep, RECORDER_QOS, raw=True
        )
        self.create_timer(0.02, self._repeat, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _keep(self, cdr: bytes) -> None:
        self._last = cdr

    def _repeat(self) -> None:
        if self._last is not None:
            self._publisher.publish(self._last)


@pytest.fixture
def checked_often(monkeypatch: pytest.MonkeyPatch) -> None:
    """Check more often than in a run, so that the tests wait less."""
    monkeypatch.setattr(sole_publishers, 'CHECK_S', 0.03)


def _graph(graph: InProcessGraph, *, recorded: bool) -> InProcessGraph:
    if not recorded:
        graph.add('driveline', {'require_recorder': False})
    graph.add_all(without=() if recorded else ['recorder'])
    return graph


def _clutch_torque(graph: InProcessGraph) -> float:
    """Return the torque in N m that the driveline integrates last."""
    outputs = graph.driveline.driveline.outputs()
    assert isinstance(outputs, DrivelineOutputs)
    return outputs.joint_effort.primary_shaft


def test_the_publishers_of_every_topic_of_a_tick_are_checked(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    graph.add('driveline')
    assert sorted(graph.driveline._sole_publishers._topics) == sorted(topic.name for topic in LOOP)


@pytest.mark.usefixtures('checked_often')
@pytest.mark.parametrize('topic', ECHOED, ids=lambda topic: topic.name)
def test_a_second_publisher_of_any_loop_topic_ends_the_run_with_its_name(
    graph_of: GraphOf, topic: Topic
) -> None:
    shift = topic in SHIFT_TOPICS
    sensed = not shift and not topic.in_run(RunKind(two_input=True, clutch='stick_slip'))
    clutch = 'linear' if topic.in_run(RunKind(two_input=True, sensed=sensed)) else 'stick_slip'
    controller = 'ls8' if topic.in_run(RunKind(clutch=clutch, sensed=sensed)) else 'mpc4'
    changes = ('sensors={}',) if sensed else ()
    recorded = topic.name in ('recorder/ack', 'engine/torque')
    scenario = 'upshift' if shift else 'thesis'
    run = plan(controller, scenario=scenario, duration_s=0.3, clutch=clutch, changes=changes)
    graph = graph_of(run)
    graph.add_other(Echo(topic, context=graph.context))
    node, complaint = _graph(graph, recorded=recorded).first_failure()
    assert node == 'driveline', complaint
    assert complaint.startswith(f'{topic.name} has two live publishers, of the nodes /')
    assert '/echo' in complaint
    assert 'another ROS_DOMAIN_ID' in complaint


class StallingClock:
    """Clock of a process that does not run for a minute before each reading."""

    def __init__(self) -> None:
        """Start at zero."""
        self.readings = 0

    def monotonic(self) -> float:
        """Return a time in s, a minute after the last one."""
        self.readings += 1
        return 60.0 * self.readings


@pytest.mark.usefixtures('checked_often')
def test_a_process_that_could_not_run_does_not_miss_the_second_publisher(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither the minutes that pass nor the wait for the first tick count as proof."""
    clock = StallingClock()
    monkeypatch.setattr(sole_publishers, 'time', clock)
    topic = ENGINE_REQUEST
    graph = graph_of(plan('mpc4', duration_s=0.02))
    graph.add_other(Echo(topic, context=graph.context))
    graph.add('driveline', {'require_recorder': False})
    graph.add('controller')
    check: Any = graph.driveline._sole_publishers
    graph.spin_until(lambda: bool(check._probes), 'a topic with a second publisher')
    probed = clock.readings
    graph.spin_until(lambda: clock.readings > probed + 40, 'more checks than the proof needs')
    graph.add_all(without=['recorder'])
    node, complaint = graph.first_failure()
    assert (node, complaint.partition(' has ')[0]) == ('driveline', topic.name)


@pytest.mark.usefixtures('checked_often')
@pytest.mark.parametrize('recorded', [True, False], ids=['recorded', 'not recorded'])
@pytest.mark.parametrize('name', COPIED)
def test_a_second_copy_of_any_node_ends_the_run_with_its_name(
    graph_of: GraphOf, name: str, recorded: bool
) -> None:
    shift = name not in NODE_NAMES
    run = plan('pi', scenario='upshift', duration_s=0.3, clutch='stick_slip')
    graph = graph_of(run if shift else plan(duration_s=0.3))
    graph.add(name, key='second')
    _, complaint = _graph(graph, recorded=recorded).first_failure()
    assert 'has two live publishers, of the nodes ' in complaint
    assert f'/{name} and /{name}' in complaint


@pytest.mark.parametrize(
    ('name', 'changes'), [('controller', {'controller': 'pi'}), ('clutch', {}), ('load', {})]
)
def test_in_real_time_a_second_publisher_opens_the_clutch_before_it_is_named(
    graph_of: GraphOf, name: str, changes: dict[str, str]
) -> None:
    graph = graph_of(plan('ls8', mode='realtime', duration_s=60.0))
    graph.add_all()
    owner = realtime_owner(graph)
    graph.spin_until(
        lambda: bool(owner.safe_clutches) or _clutch_torque(graph) > 10.0,
        'a clutch that transmits',
    )
    if owner.safe_clutches:
        late = owner.worst_lateness_s >= STALL_S or owner.late
        assert late, 'it was opened though no tick and no reply was late'
        pytest.skip(
            f'too busy for real time: ticks were {1e3 * owner.worst_lateness_s:.0f} ms late, '
            f'and {owner.late} replies'
        )
    rename = ['--ros-args', '-r', f'{name}:__node:=other', '-r', 'run_info:=other_info']
    graph.add(name, changes, key='second', cli_args=rename)
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    assert f' has two live publishers, of the nodes /{name} and /other' in complaint
    assert abs(_clutch_torque(graph)) < 1e-6


def test_a_killed_node_that_is_still_in_the_graph_is_no_second_publisher(
    graph_of: GraphOf, programs: Programs
) -> None:
    run = plan(duration_s=0.3)
    graph = graph_of(run)
    load = programs.start_node('ddct_plant.nodes.load_node', graph.parameters['*'])
    graph.wait_for_publisher('load/torque', START_S)
    load.process.kill()
    load.wait()
    graph.add_all()
    graph.run()
    assert graph.nodes['driveline'].count_publishers('load/torque') == 2, 'it was forgotten'
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()


@pytest.mark.usefixtures('checked_often')
def test_a_driveline_that_is_closed_in_doubt_ends_its_check_quietly(graph_of: GraphOf) -> None:
    """In one process its timers run on, while the other nodes are closed."""
    graph = graph_of(plan(duration_s=600.0))
    stranger = Node('stranger', context=graph.context)
    graph.add_other(stranger)
    stranger.create_publisher(VEHICLE_ACCEL.message_class, VEHICLE_ACCEL.name, RECORDER_QOS)
    graph.add_all()
    check: Any = graph.driveline._sole_publishers
    graph.spin_until(lambda: bool(check._probes), 'a topic with a second publisher')
    checks: list[bool] = []
    in_doubt = check._in_doubt
    check._in_doubt = lambda: checks.append(in_doubt())
    graph.driveline.close()
    graph.spin_until(lambda: len(checks) >= 3, 'three more checks')
    assert not any(checks)
