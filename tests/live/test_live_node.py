# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The node `live` in one process with its input: runs in succession, and no run at all."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rosgraph_msgs.msg import Clock
from viewer import Viewer
from waiting import wait_until

from ddct_bringup.live import live_node
from ddct_plant.base.timebase import START_NS, stamp_of_step
from ddct_plant.graph.qos import LATCHED_QOS, LOOP_QOS
from ddct_plant.graph.spin import make_executor
from ddct_plant.signals.topics import CLOCK, DIAGNOSTICS, RUN_INFO

pytestmark = pytest.mark.usefixtures('extras')


class Served:
    """Node `live` and a node that publishes as the graph, in this process."""

    def __init__(self, context: Context) -> None:
        """Serve on a free port; its printed lines go to `printed`."""
        self.printed: list[str] = []
        self.node = live_node.LiveNode('127.0.0.1', 0, self.printed.append, context=context)
        self.graph = Node('graph', context=context)
        self.executor: Executor = make_executor(context)
        for node in (self.node, self.graph):
            self.executor.add_node(node)

    @property
    def url(self) -> str:
        return self.printed[0].split()[-1]

    def spin(self) -> bool:
        """Spin the nodes for a moment; return True, for use in a condition."""
        self.executor.spin_until_future_complete(Future(), 0.02)
        return True


@contextmanager
def served(*arguments: str) -> Iterator[Served]:
    context = Context()
    rclpy.init(
        args=list(arguments), context=context, signal_handler_options=SignalHandlerOptions.NO
    )
    both = Served(context)
    try:
        yield both
    finally:
        both.node.close()
        both.executor.shutdown()
        for node in (both.node, both.graph):
            node.destroy_node()
        context.try_shutdown()


def test_the_time_goes_back_when_the_next_run_begins() -> None:
    with served() as both:
        clock = both.graph.create_publisher(Clock, '/clock', LOOP_QOS)
        with Viewer(both.url) as viewer:

            def is_at(stamp: int) -> bool:
                return both.spin() and viewer.times[-1:] == [stamp]

            wait_until(lambda: both.spin() and clock.get_subscription_count() == 1, 'the match')
            for step in (0, 100, 200, 0, 1):
                stamp = stamp_of_step(step)
                clock.publish(CLOCK.message(stamp))
                wait_until(partial(is_at, stamp), f'{stamp} ns')
    shown = [
        time for time, last in zip(viewer.times, [0, *viewer.times], strict=False) if time != last
    ]
    assert shown == [stamp_of_step(step) for step in (0, 100, 200, 0, 1)]


def has_all(viewer: Viewer) -> bool:
    """Return whether a viewer has what three nodes and one of the off-going side published."""
    counts = [len(viewer.messages[name]) for name in ('/run_info', '/off_going/run_info')]
    return counts[0] >= 3 and counts[1] >= 1


def test_a_late_viewer_gets_the_time_and_what_is_latched_the_controller_last() -> None:
    now = stamp_of_step(300)
    with served() as both:
        clock = both.graph.create_publisher(Clock, '/clock', LOOP_QOS)
        latched = []
        for name in ('/engine', '/controller', '/off_going/clutch', '/recorder'):
            topic = f'{name.rpartition("/")[0]}/run_info'
            latched.append(both.graph.create_publisher(DiagnosticArray, topic, LATCHED_QOS))
            latched[-1].publish(RUN_INFO.message(START_NS, [('version', '1')], name=name))
        with Viewer(both.url) as early:
            wait_until(lambda: both.spin() and clock.get_subscription_count() == 1, 'the match')
            clock.publish(CLOCK.message(now))
            wait_until(lambda: both.spin() and has_all(early), 'run_info')
            wait_until(lambda: both.spin() and early.times[-1:] == [now], 'the time')
        with Viewer(both.url) as late:
            wait_until(lambda: both.spin() and has_all(late), 'run_info')
    assert late.times[0] == now
    for topic, nodes in (
        ('/run_info', ('/engine', '/recorder', '/controller')),
        ('/off_going/run_info', ('/off_going/clutch',)),
    ):
        seen = [(stamp, RUN_INFO.read(message)[0]) for stamp, message in late.decoded(topic)]
        assert seen == [(START_NS, name) for name in nodes]


def test_a_graph_sends_nothing_without_a_viewer() -> None:
    with served() as both:
        clock = both.graph.create_publisher(Clock, '/clock', LOOP_QOS)
        run_info = both.graph.create_publisher(DiagnosticArray, 'run_info', LATCHED_QOS)
        wait_until(lambda: both.spin() and run_info.get_subscription_count() == 1, 'the match')
        assert clock.get_subscription_count() == 0
        with Viewer(both.url):
            wait_until(lambda: both.spin() and clock.get_subscription_count() == 1, 'the match')


def test_diagnostics_of_a_graph_in_a_namespace_have_the_names_that_the_layout_shows() -> None:
    with served('--ros-args', '-r', '__ns:=/car', '-r', '/clock:=/car/clock') as both:
        diagnostics = both.graph.create_publisher(DiagnosticArray, '/diagnostics', LOOP_QOS)
        with Viewer(both.url) as viewer:
            wait_until(
                lambda: both.spin() and diagnostics.get_subscription_count() == 1, 'the match'
            )
            for name in ('/driveline: ticks', '/car70/driveline: ticks', '/car/driveline: ticks'):
                diagnostics.publish(DIAGNOSTICS.message(START_NS, [], name=name))
            wait_until(lambda: both.spin() and bool(viewer.messages['/diagnostics']), 'a status')
    shown = [message.status[0].name for _, message in viewer.decoded('/diagnostics')]
    assert shown == ['/driveline: ticks']


def test_a_domain_without_a_graph_is_reported_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live_node, '_PATIENCE_S', 0.05)
    with served() as both:
        wait_until(lambda: both.spin() and len(both.printed) > 1, 'the message')
        for _ in range(10):
            both.spin()
    assert len(both.printed) == 2
    assert 'no graph with /clock in ROS domain' in both.printed[1]
    assert 'ROS_DOMAIN_ID' in both.printed[1]


def test_a_running_graph_is_not_reported_as_absent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live_node, '_PATIENCE_S', 0.5)
    with served('--ros-args', '-r', '/clock:=/car/clock') as both:
        both.graph.create_publisher(Clock, '/clock', LOOP_QOS)
        for _ in range(50):
            both.spin()
    assert len(both.printed) == 1
