# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real time: an engine whose requests stop, or never come, goes on by its ticks alone."""

from functools import partial
from typing import Any

import pytest
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import plan

from ddct_plant.base.timebase import PERIOD_S, stamp_of_step, step_of_stamp
from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topics import ENGINE_REQUEST, ENGINE_TORQUE, JOINT_STATES

LITTLE_SLEW = 'engine_authority.slew_n_m_s=500'
TIMEOUT_STEPS = round(REQUEST_TIMEOUT_S / PERIOD_S)


class _Driver(Node):
    """Substitute for driveline and controller; stores the engine's answers in order."""

    def __init__(self, **options: Any) -> None:
        super().__init__('driver', **options)
        self.answers: list[tuple[int, float]] = []
        self._joints = self.create_publisher(JointState, 'driveline/joint_states', LOOP_QOS)
        self._request = self.create_publisher(WrenchStamped, 'engine/torque_request', LOOP_QOS)
        self.create_subscription(WrenchStamped, 'engine/torque', self._on_torque, LOOP_QOS)

    def tick(self, step: int, speed: float = 0.0) -> None:
        """Publish the tick of a step with a speed of the engine in rad/s."""
        zero = [0.0] * 4
        speeds = [speed, 0.0, 0.0, 0.0]
        self._joints.publish(JOINT_STATES.message(stamp_of_step(step), zero, speeds, zero))

    def request(self, step: int, torque: float) -> None:
        """Publish the request of a step."""
        self._request.publish(ENGINE_REQUEST.message(stamp_of_step(step), torque))

    def connected(self) -> bool:
        """Return whether the engine is connected."""
        publishers = (self._joints, self._request)
        connected = all(each.get_subscription_count() for each in publishers)
        return connected and self.count_publishers('engine/torque') > 0

    def _on_torque(self, message: WrenchStamped) -> None:
        self.answers.append((step_of_stamp(stamp_ns(message)), ENGINE_TORQUE.read(message)))


def _driven(
    graph_of: GraphOf, change: str = LITTLE_SLEW, scenario: str = 'thesis'
) -> tuple[InProcessGraph, _Driver]:
    demand = ('engine.time_s=[0.0]', 'engine.torque_n_m=[308.0]')
    graph = graph_of(plan('mpc4', mode='realtime', scenario=scenario, changes=(change, *demand)))
    graph.add('engine')
    driver = _Driver(context=graph.context)
    graph.add_other(driver)
    assert driver.connected()
    return graph, driver


def test_in_real_time_requests_that_come_back_change_nothing(
    graph_of: GraphOf, capfd: pytest.CaptureFixture[str]
) -> None:
    graph, driver = _driven(graph_of)

    def answered(count: int) -> bool:
        return len(driver.answers) == count

    driver.tick(0)
    driver.request(0, 320.0)
    graph.spin_until(partial(answered, 1), 'the answer to a request')
    first, second = TIMEOUT_STEPS + 1, TIMEOUT_STEPS + 2
    for step in range(1, second + 1):
        driver.tick(step)
    graph.spin_until(partial(answered, 3), 'two answers without a request')
    driver.tick(second)
    graph.spin_until(partial(answered, 4), 'the answer to a tick that comes again')
    for step in (first, second, second + 1):
        driver.request(step, 400.0)
    driver.tick(second + 1)
    graph.spin_until(partial(answered, 5), 'the answer to the tick after a request')
    assert driver.answers == [
        (0, 313.0),
        (first, 315.0),  # in between 320 were held, which a slow engine came to
        (second, 310.0),
        (second, 310.0),
        (second + 1, 308.0),
    ]
    assert capfd.readouterr().err.count('the demand holds until the engine is started again') == 1


def test_in_real_time_the_demand_is_delivered_until_the_first_request_and_not_held(
    graph_of: GraphOf,
) -> None:
    graph, driver = _driven(graph_of)
    first = TIMEOUT_STEPS + 1
    driver.tick(first)
    graph.spin_until(lambda: bool(driver.answers), 'an answer without a request')
    for step in (first, first + 1):
        driver.request(step, 320.0)
    driver.tick(first + 1)
    graph.spin_until(lambda: len(driver.answers) == 2, 'the answer to a request')
    assert driver.answers == [(first, 308.0), (first + 1, 313.0)]


def test_in_real_time_an_engine_alone_has_the_limits_of_its_present_speed(
    graph_of: GraphOf,
) -> None:
    """Its full load is 250 N m at 261.8 rad/s and 170 N m at 157.08 rad/s."""
    full_load = [0, 110, 170, 225, 250, 217, 165, 308]
    graph, driver = _driven(
        graph_of, f'engine_limits={{full_load_n_m: {full_load}}}', 'thesis_sticking'
    )
    driver.tick(0, 261.8)
    driver.request(0, 320.0)
    graph.spin_until(lambda: len(driver.answers) == 1, 'the answer to a request')
    first = TIMEOUT_STEPS + 1
    for step in range(1, first + 1):
        driver.tick(step, 157.08)
    graph.spin_until(lambda: len(driver.answers) == 2, 'an answer without a request')
    assert driver.answers == [(0, 250.0), (first, 170.0)]
