# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller of clutch and engine: one run in every layout, and an error if miswired."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from rclpy.node import Node
from samples import sampled
from support.altering import add_silent
from support.in_process_graph import GraphOf
from support.runs import LAYOUTS, bag_bytes, expected, plan, record

from ddct_bringup.run.plan import RunPlan
from ddct_plant.base.timebase import PERIOD_S, step_of_stamp
from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topics import ENGINE_REQUEST, ENGINE_TORQUE

pytestmark = pytest.mark.slow

SLEW_N_M_S = 500.0
LITTLE_SLEW = f'engine_authority.slew_n_m_s={SLEW_N_M_S}'
TIMEOUT_STEPS = round(REQUEST_TIMEOUT_S / PERIOD_S)
SILENT_AT_STEP = 112
"""Step at which a corner of the reference has just made the controller move the engine."""
AWAY_STEPS = 20
"""Steps for which a controller is stopped."""


@pytest.mark.parametrize(
    ('controller', 'changes', 'layouts'),
    [
        ('mpc4', (), LAYOUTS),
        pytest.param(
            'mpc4_wear',
            ('engine_authority.slew_n_m_s=800.0', 'engine_authority.lag_s=0.03'),
            LAYOUTS[1:],
            marks=pytest.mark.nightly,
        ),
    ],
    ids=['free', 'little authority'],
)
def test_every_layout_leaves_the_same_bytes_and_the_headless_trajectory(
    tmp_path: Path, controller: str, changes: tuple[str, ...], layouts: tuple[str, ...]
) -> None:
    bags = []
    for layout in layouts:
        run = plan(controller, layout, changes=changes)
        folder = tmp_path / layout
        recording = record(run, folder)
        trajectory = recording.trajectory
        assert trajectory.sha256() == expected(run).sha256(), layout
        assert trajectory.two_input
        assert np.ptp(trajectory.engine_torque - trajectory.torque_demand) > 10.0
        bags.append(bag_bytes(folder))
    assert all(bag == bags[0] for bag in bags)


def test_a_commanded_engine_with_limits_is_the_headless_one_while_the_shaft_stands(
    tmp_path: Path,
) -> None:
    changes = ['duration_s=0.6', 'score_window_s=[0.3,0.6]']
    settings = RunSettings(KnownSettings(load_scenario('launch', changes)))
    run = RunPlan(settings, 'mpc4', 'single-process')
    trajectory = record(run, tmp_path / 'run').trajectory
    assert trajectory.sha256() == expected(run).sha256()
    engine, shaft = trajectory.joint_speed[:, 0], trajectory.joint_speed[:, 1]
    assert engine[30] > shaft[30] + 50.0


def test_an_engine_that_does_not_expect_requests_ends_with_an_error(graph_of: GraphOf) -> None:
    graph = graph_of(plan('mpc4'))
    graph.add('engine', {'two_input': False})
    graph.add_all(without=['recorder'])
    node, complaint = graph.first_failure()
    assert node == 'engine'
    for words in (
        'engine/torque_request arrived',
        'follows the demand alone',
        '-p two_input:=true',
    ):
        assert words in complaint


class _Listener(Node):
    """Subscriber that stores the engine's torques by topic and step."""

    def __init__(self, **options: Any) -> None:
        super().__init__('listener', **options)
        self.demands: dict[int, float] = {}
        self.torques: dict[int, float] = {}
        for topic, torques in (('torque_demand', self.demands), ('torque', self.torques)):
            keep = partial(self._keep, torques)
            self.create_subscription(WrenchStamped, f'engine/{topic}', keep, RECORDER_QOS)

    @staticmethod
    def _keep(torques: dict[int, float], message: WrenchStamped) -> None:
        torques[step_of_stamp(stamp_ns(message))] = ENGINE_TORQUE.read(message)


@pytest.mark.parametrize('answers_again', sampled([True, False], every=2))
def test_in_real_time_the_engine_goes_back_to_the_demand_when_requests_stop_and_stays_there(
    graph_of: GraphOf, answers_again: bool
) -> None:
    run = plan('mpc4', mode='realtime', duration_s=1.8, changes=(LITTLE_SLEW,))
    graph = graph_of(run)
    until = SILENT_AT_STEP + AWAY_STEPS if answers_again else run.steps + 1
    add_silent(graph, ENGINE_REQUEST.name, 'engine', range(SILENT_AT_STEP, until))
    listener = _Listener(context=graph.context)
    graph.add_other(listener)
    graph.add_all()
    graph.run()
    demands, torques = listener.demands, listener.torques
    last, first = SILENT_AT_STEP - 1, SILENT_AT_STEP + TIMEOUT_STEPS
    assert sorted(set(range(run.steps + 1)) - set(torques)) == list(range(last + 1, first))
    alone = range(first, run.steps + 1)
    before = torques[last] - demands[last]
    assert abs(before) > 10.0
    deviations = np.array([torques[step] - demands[step] for step in alone])
    most_change = SLEW_N_M_S * PERIOD_S
    assert abs(deviations[0] - before) <= (first - last) * most_change + 1e-9
    left = np.maximum(abs(deviations[0]) - (np.array(alone) - first) * most_change, 0.0)
    np.testing.assert_allclose(np.abs(deviations), left, atol=1e-9)
    assert left[-1] == 0.0
