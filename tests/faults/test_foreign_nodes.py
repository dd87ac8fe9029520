# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Third parties' nodes in the graph: the recorder names their missing values."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import Any

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TwistStamped
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from support.in_process_graph import GraphOf, InProcessGraph, node_class
from support.runs import plan
from waiting import wait_until

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_bringup.record.recorder_node import PATIENCE_S
from ddct_plant.graph import sole_publishers
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_LATCHED_QOS
from ddct_plant.graph.sole_publishers import CHECK_S, NAMING_S, OPEN_S, publishers_of

NODE_NAMES = [node.name for node in GRAPH_NODES]


def test_a_waiting_recorder_names_the_missing_nodes(
    graph_of: GraphOf, capfd: pytest.CaptureFixture[str]
) -> None:
    graph = graph_of(plan())
    graph.add('recorder', {'nodes': [*NODE_NAMES, 'bench']})
    graph.pass_time(0.99 * PATIENCE_S)
    assert 'no run_info' not in capfd.readouterr().err
    graph.pass_time(0.02 * PATIENCE_S)
    words = capfd.readouterr().err
    assert 'no run_info came from' in words
    for node in set(NODE_NAMES) - {'recorder'} | {'bench'}:
        assert node in words


def test_a_recorder_that_recorded_nothing_names_the_cause(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    recorder: Any = graph.add('recorder', {'nodes': ['recorder']})
    graph.spin_until(lambda: not recorder._nodes.missing(), 'its own run_info')
    recorder.close()
    words = f'{graph.folder}: nothing was recorded, no whole tick came: start it first, or '
    assert graph.failures()['recorder'].startswith(words)


def test_a_recorder_that_got_no_whole_tick_names_the_topics_that_it_lacks(
    graph_of: GraphOf,
) -> None:
    graph = graph_of(plan())
    recorder: Any = graph.add('recorder', {'nodes': [n for n in NODE_NAMES if n != 'clutch']})
    graph.add_all(without=['clutch'])
    graph.spin_until(lambda: recorder._buffer.missing() == ['clutch/torque'], 'all other topics')
    recorder.close()
    words = 'no whole tick came, for want of clutch/torque: see the logs of the nodes'
    assert words in graph.failures()['recorder']


def test_a_recorder_warns_of_a_run_that_ended_early(
    graph_of: GraphOf, capfd: pytest.CaptureFixture[str]
) -> None:
    graph = graph_of(plan())
    graph.add_all()
    recorder: Any = graph.nodes['recorder']
    graph.spin_until(lambda: recorder._bag.steps == 9, 'the tick')
    recorder.close()
    assert f'{graph.folder}: ended after 9 of 100 steps: not valid' in capfd.readouterr().err


@pytest.mark.parametrize(('node', 'key'), [('controller', 'controller'), ('driveline', 'steps')])
def test_a_run_info_without_what_the_bag_needs_is_named(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, node: str, key: str
) -> None:
    def publish_without_extra(node: GraphNode, extra: object = None) -> None:
        GraphNode.publish_run_info(node)

    monkeypatch.setattr(node_class(node), 'publish_run_info', publish_without_extra)
    graph = graph_of(plan())
    graph.add_all()
    failed, complaint = graph.first_failure()
    assert failed == 'recorder'
    assert f'run_info of node /{node} has no {key}' in complaint


@pytest.mark.parametrize('topic', ['run_info', 'controller/timing'])
def test_an_empty_report_ends_the_recorder_with_its_topic(graph_of: GraphOf, topic: str) -> None:
    assert topic in complaint_of_recorder(graph_of, topic, DiagnosticArray())


@pytest.mark.parametrize('times', ['soon', '1.0 nan', '-1.0', 'inf'])
def test_update_times_that_are_none_end_the_recorder_with_their_topic(
    graph_of: GraphOf, times: str
) -> None:
    pairs = [KeyValue(key='update_times_us', value=times)]
    report = DiagnosticArray(status=[DiagnosticStatus(name='/controller', values=pairs)])
    complaint = complaint_of_recorder(graph_of, 'controller/timing', report)
    assert 'controller/timing update_times_us' in complaint


def complaint_of_recorder(graph_of: GraphOf, topic: str, message: DiagnosticArray) -> str:
    """Publish a message and return the error of the recorder that receives it."""
    graph = graph_of(plan())
    graph.add('recorder')
    stranger = Node('stranger', context=graph.context)
    graph.add_other(stranger)
    qos = RECORDER_LATCHED_QOS if topic == 'run_info' else LOOP_QOS
    publisher = stranger.create_publisher(DiagnosticArray, topic, qos)
    publisher.publish(message)
    failed, complaint = graph.first_failure()
    assert failed == 'recorder'
    assert '\n' not in complaint
    return complaint


@contextmanager
def another_type(graph: InProcessGraph) -> Iterator[None]:
    """Let a node publish `load/torque` as another type, which the graph has found."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        stranger = Node('stranger', context=context)
        stranger.create_publisher(TwistStamped, 'load/torque', LOOP_QOS)
        wait_until(lambda: '/stranger' in publishers_of(graph.watch, 'load/torque'), 'its name')
        yield
        stranger.destroy_node()
    finally:
        context.try_shutdown()


def complaint_about_another_type(graph: InProcessGraph) -> str:
    """Return the error of the driveline."""
    failed, complaint = graph.first_failure()
    assert failed == 'driveline'
    assert complaint.startswith('load/torque is published as geometry_msgs/msg/TwistStamped too')
    return complaint


def test_a_topic_of_another_type_is_named(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    with another_type(graph):
        graph.add_all()
        assert '/stranger' in complaint_about_another_type(graph)


@pytest.mark.parametrize(
    ('mode', 'unnamed_calls', 'at_s'),
    [
        ('lockstep', 3, 3 * CHECK_S),  # the run is over at once, and the first look with it
        pytest.param('lockstep', 10**6, CHECK_S + NAMING_S, marks=pytest.mark.nightly),
        ('realtime', 1, CHECK_S + OPEN_S),
    ],
)
def test_an_error_about_a_second_publisher_waits_a_while_for_its_name(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, mode: str, unnamed_calls: int, at_s: float
) -> None:
    """The middleware lists a topic before the name of its node."""
    calls = count()
    name_late(monkeypatch, lambda: next(calls) < unnamed_calls)
    graph = graph_of(plan(mode=mode, duration_s=1.5))
    with another_type(graph):
        graph.add_all()
        complaint = complaint_about_another_type(graph)
    assert ('/stranger' in complaint) == (unnamed_calls <= 3)
    assert graph.time is not None
    assert graph.time.monotonic() == pytest.approx(at_s, abs=1e-4)


def test_a_real_time_run_that_is_over_first_waits_for_the_name_of_the_second_publisher(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = count()
    name_late(monkeypatch, lambda: owner.step < owner.last_step or next(calls) < 2)
    graph = graph_of(plan(mode='realtime', duration_s=0.6))
    graph.add_all()
    owner = graph.driveline.owner
    graph.spin_until(lambda: owner.step >= 5, 'step 5')
    with another_type(graph):
        assert '/stranger' in complaint_about_another_type(graph)
    assert owner.step == owner.last_step and next(calls) > 2
    assert graph.time is not None
    assert graph.time.monotonic() == pytest.approx(0.6 + 2 * CHECK_S, abs=1e-4)


def name_late(monkeypatch: pytest.MonkeyPatch, late: Callable[[], bool]) -> None:
    """Let the middleware list the stranger without its name where `late()` is true."""

    def named_late(node: Node, topic: str) -> str:
        shown = publishers_of(node, topic)
        return shown.replace('/stranger', sole_publishers._UNNAMED) if late() else shown

    monkeypatch.setattr(sole_publishers, 'publishers_of', named_late)
