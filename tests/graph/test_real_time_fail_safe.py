# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time: the clutch opens by itself, at the stated rate, when requests stop."""

from functools import partial
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from support.altering import add_silent
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan
from trajectory_msgs.msg import JointTrajectory

from ddct_plant.base.timebase import PERIOD_S, stamp_of_step, step_of_stamp
from ddct_plant.fail_safe.request_watch import FailSafeSettings
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_QOS
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topics import ACTUATOR_TORQUE, CLOCK, TORQUE_REQUEST

FAIL_SAFE = FailSafeSettings()
HELD_STEPS = round(FAIL_SAFE.request_timeout_s / PERIOD_S)
SILENT_AT_STEP = 80
AWAY_STEPS = 20
"""Steps for which a controller is stopped."""
SETTLING_STEPS = 10
"""The delay of one period and about four time constants of G_a (Section 1.4.2)."""


class _Listener(Node):
    """Subscriber that stores the requests and the actuator's torques by step."""

    def __init__(self, **options: Any) -> None:
        super().__init__('listener', **options)
        self.requests: dict[int, float] = {}
        self.torques: dict[int, float] = {}
        self.create_subscription(
            WrenchStamped, 'clutch/torque_request', self._on_request, RECORDER_QOS
        )
        self.create_subscription(JointTrajectory, 'actuator/torque', self._on_torque, RECORDER_QOS)

    def has_torque(self, step: int) -> bool:
        """Return whether the actuator has answered this step."""
        return step in self.torques

    def _on_request(self, message: WrenchStamped) -> None:
        self.requests[step_of_stamp(stamp_ns(message))] = TORQUE_REQUEST.read(message)

    def _on_torque(self, message: JointTrajectory) -> None:
        self.torques[step_of_stamp(stamp_ns(message))] = ACTUATOR_TORQUE.read(message)[0][0]


@pytest.mark.parametrize('answers_again', [False, True], ids=['silent', 'silent for a while'])
def test_the_clutch_opens_at_the_stated_rate_and_stays_open(
    graph_of: GraphOf, answers_again: bool
) -> None:
    run = plan(mode='realtime', duration_s=1.8)
    graph = graph_of(run)
    until = SILENT_AT_STEP + AWAY_STEPS if answers_again else run.steps + 1
    add_silent(graph, TORQUE_REQUEST.name, 'actuator', range(SILENT_AT_STEP, until))
    listener = _Listener(context=graph.context)
    graph.add_other(listener)
    graph.add_all()
    graph.run()
    engaged = SILENT_AT_STEP + HELD_STEPS
    unanswered = sorted(set(range(run.steps + 1)) - set(listener.torques))
    assert unanswered == list(range(SILENT_AT_STEP, engaged))
    last_request = listener.requests[SILENT_AT_STEP - 1]
    assert last_request > 200.0, 'the clutch was open before the requests stopped'
    ramp_steps = round(last_request / FAIL_SAFE.fail_safe_ramp_n_m_s / PERIOD_S)
    torque = np.array([listener.torques[step] for step in range(engaged, run.steps + 1)])
    rate_n_m_s = -np.diff(torque) / PERIOD_S
    on_the_ramp = rate_n_m_s[SETTLING_STEPS:ramp_steps]
    assert on_the_ramp == pytest.approx(FAIL_SAFE.fail_safe_ramp_n_m_s, rel=0.03)
    assert rate_n_m_s.max() < 1.03 * FAIL_SAFE.fail_safe_ramp_n_m_s
    assert np.abs(torque[ramp_steps + SETTLING_STEPS :]).max() < 0.01 * last_request


class _Bench(_Listener):
    """Substitute for plant and controller."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.time = -1
        self._ticks = self.create_publisher(Clock, '/clock', LOOP_QOS)
        self.create_subscription(Clock, '/clock', self._on_clock, LOOP_QOS)
        self._request = self.create_publisher(WrenchStamped, 'clutch/torque_request', LOOP_QOS)

    def connected(self) -> bool:
        """Return whether the actuator is connected."""
        listener = all(each.get_subscription_count() for each in (self._ticks, self._request))
        return listener and self.count_publishers('actuator/torque') > 0

    def is_at(self, step: int) -> bool:
        """Return whether the time of this step was received."""
        return self.time == step

    def publish_time(self, step: int) -> None:
        """Publish the time of a step."""
        self._ticks.publish(CLOCK.message(stamp_of_step(step)))

    def request(self, step: int, torque: float = 200.0) -> None:
        """Publish a request for a step."""
        self._request.publish(TORQUE_REQUEST.message(stamp_of_step(step), torque))

    def _on_clock(self, message: Clock) -> None:
        self.time = step_of_stamp(stamp_ns(message))


@pytest.fixture
def bench(graph_of: GraphOf) -> tuple[InProcessGraph, _Bench]:
    """Return a graph with an actuator in real time and nothing else but a bench."""
    graph = graph_of(plan(mode='realtime'))
    graph.add('actuator')
    bench = _Bench(context=graph.context)
    graph.add_other(bench)
    assert bench.connected()
    return graph, bench


def test_requests_without_clock_give_no_torque_and_end_the_actuator(
    bench: tuple[InProcessGraph, _Bench],
) -> None:
    graph, driver = bench
    for step in range(HELD_STEPS + 2):
        driver.request(step)
    node, complaint = graph.first_failure()
    assert node == 'actuator'
    for words in (f'at stamp {stamp_of_step(HELD_STEPS + 1)} ns', 'publish /clock'):
        assert words in complaint
    assert not driver.torques


def test_a_late_clock_makes_the_actuator_answer(
    bench: tuple[InProcessGraph, _Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    graph, driver = bench
    actuator: Any = graph.nodes['actuator']
    publish, published = actuator._torque.publish, []

    def noted() -> None:
        published.append(actuator.join.last_step)
        publish()

    monkeypatch.setattr(actuator._torque, 'publish', noted)
    driver.request(0)
    graph.spin_until(lambda: actuator.join.last_step == 0, 'the request')
    assert not published
    driver.publish_time(0)

    def answered_again() -> bool:
        driver.request(0)
        return driver.has_torque(0)

    graph.spin_until(answered_again, 'the answer to a request that comes again')
    for step in range(1, 2 * HELD_STEPS):
        driver.publish_time(step)
        graph.spin_until(partial(driver.is_at, step), 'the tick')
        driver.request(step)
        graph.spin_until(partial(driver.has_torque, step), 'the torque')
