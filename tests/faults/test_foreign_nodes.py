# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Third parties' nodes in the graph: the recorder names their missing values."""

from collections.abc import Callable
from itertools import count
from types import SimpleNamespace
from typing import Any

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TwistStamped
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from support.in_process_graph import GraphOf, InProcessGraph, node_class
from support.patient_clock import realtime_owner
from support.runs import plan

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_bringup.record import recorder_node
from ddct_plant.graph import sole_publishers
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_LATCHED_QOS

NODE_NAMES = [node.name for node in GRAPH_NODES]


def test_a_waiting_recorder_names_the_missing_nodes(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(recorder_node, 'PATIENCE_S', 0.3)
    graph = graph_of(plan())
    graph.add('recorder', {'nodes': [*NODE_NAMES, 'bench']})
    printed: list[str] = []

    def warned() -> bool:
        printed.append(capfd.readouterr().err)
        return 'no run_info came from' in ''.join(printed)

    graph.spin_until(warned, 'the warning of the recorder')
    words = ''.join(printed)
    for node in set(NODE_NAMES) - {'recorder'} | {'bench'}:
        assert node in words


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
    stranger.create_timer(0.02, lambda: publisher.publish(message))
    failed, complaint = graph.first_failure()
    assert failed == 'recorder'
    assert '\n' not in complaint
    return complaint


def complaint_about_another_type(graph: InProcessGraph) -> str:
    """Run beside a node that publishes `load/torque` as another type; return the error."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        stranger = Node('stranger', context=context)
        stranger.create_publisher(TwistStamped, 'load/torque', LOOP_QOS)
        graph.add_all()
        failed, complaint = graph.first_failure()
        stranger.destroy_node()
    finally:
        context.try_shutdown()
    assert failed == 'driveline'
    assert complaint.startswith('load/torque is published as geometry_msgs/msg/TwistStamped too')
    return complaint


def test_a_topic_of_another_type_is_named(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sole_publishers, 'CHECK_S', 0.03)
    assert '/stranger' in complaint_about_another_type(graph_of(plan()))


@pytest.mark.parametrize(
    ('mode', 'unnamed_calls'), [('lockstep', 3), ('lockstep', 10**6), ('realtime', 1)]
)
def test_an_error_about_a_second_publisher_waits_a_while_for_its_name(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, mode: str, unnamed_calls: int
) -> None:
    """The middleware lists a topic before the name of its node."""
    if unnamed_calls > 3:
        monkeypatch.setattr(sole_publishers, 'NAMING_S', 0.3)
    # Each look at the publishers takes the same time, however busy the machine is.
    looks = count()
    clock = SimpleNamespace(monotonic=lambda: 0.125 * next(looks))
    monkeypatch.setattr(sole_publishers, 'time', clock)
    # It ends the node before the run is over.
    monkeypatch.setattr(sole_publishers, 'OPEN_S', 0.3)
    calls = count()
    name_late(monkeypatch, lambda: next(calls) < unnamed_calls)
    complaint = complaint_about_another_type(graph_of(plan(mode=mode)))
    assert next(calls) > min(unnamed_calls, 3)
    assert ('/stranger' in complaint) == (unnamed_calls <= 3)


def test_a_real_time_run_that_is_over_first_waits_for_the_name_of_the_second_publisher(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sole_publishers, 'OPEN_S', 60.0)
    calls = count()
    name_late(monkeypatch, lambda: owner.step < owner.last_step or next(calls) < 3)
    graph = graph_of(plan(mode='realtime', duration_s=60.0))
    graph.add_all()
    owner = realtime_owner(graph)
    check: Any = graph.driveline._sole_publishers
    # The run is over once the second publisher has brought the clutch into its safe state.
    monkeypatch.setattr(owner, '_over', lambda: bool(check.found and owner.safe_clutches))
    graph.spin_until(lambda: owner.step >= 5, 'step 5')
    assert '/stranger' in complaint_about_another_type(graph)
    assert owner.step == owner.last_step and next(calls) > 3


def name_late(monkeypatch: pytest.MonkeyPatch, late: Callable[[], bool]) -> None:
    """Let the middleware list the stranger without its name where `late()` is true."""
    monkeypatch.setattr(sole_publishers, 'CHECK_S', 0.03)
    publishers_of = sole_publishers.publishers_of

    def named_late(node: Node, topic: str) -> str:
        shown = publishers_of(node, topic)
        return shown.replace('/stranger', sole_publishers._UNNAMED) if late() else shown

    monkeypatch.setattr(sole_publishers, 'publishers_of', named_late)
