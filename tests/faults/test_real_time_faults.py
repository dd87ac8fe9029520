# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""In real time bad messages count as missing, and missing ones lead to a safe state."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import WrenchStamped
from samples import sampled
from support.altering import add_altering, add_silent, changing, remaps
from support.in_process_graph import GraphOf
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.run.timing_and_failure import read_timing
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.timebase import PERIOD_S, stamp_of_step
from ddct_plant.fail_safe.request_watch import CLUTCH_TIMEOUT_S, FailSafeSettings
from ddct_plant.signals.topics import CLOCK, CLUTCH_TORQUE, LOAD_TORQUE, TOPICS
from ddct_plant.ticks.realtime_owner import RealtimeOwner

CLUTCH, LOAD = CLUTCH_TORQUE.name, LOAD_TORQUE.name
FROM_STEP = 20
FAIL_SAFE = FailSafeSettings()
FUTURE_STEPS = FROM_STEP + 60_000, (2_147_483_640 - 1) * 100
"""A step in ten minutes, and that of the last stamp of a message, less some seconds."""


def _nan(message: WrenchStamped) -> None:
    message.wrench.torque.x = math.nan


def _infinite(message: WrenchStamped) -> None:
    message.wrench.torque.x = math.inf


def _off_grid(message: WrenchStamped) -> None:
    message.header.stamp.nanosec += 1


def _time_zero(message: WrenchStamped) -> None:
    message.header.stamp.sec = message.header.stamp.nanosec = 0


def _future(message: WrenchStamped) -> None:
    message.header.stamp.sec += 600


def _latest(message: WrenchStamped) -> None:
    message.header.stamp.sec = 2_147_483_640


@pytest.mark.parametrize(
    'spoil', sampled([_nan, _infinite, _off_grid, _time_zero, _future, _latest], every=2)
)
def test_bad_requests_count_as_missing_and_open_the_clutch(
    graph_of: GraphOf, spoil: Callable[[Any], None]
) -> None:
    graph = graph_of(plan(mode='realtime', duration_s=0.9))
    topic = 'clutch/torque_request'
    graph.add('actuator', cli_args=remaps('actuator', [topic]))
    add_altering(graph, topic, changing(spoil, FROM_STEP), reader='actuator')
    graph.add_all()
    graph.run()
    recording = read_bag(graph.folder)
    opened = FROM_STEP + round(FAIL_SAFE.request_timeout_s / PERIOD_S)
    assert recording.realtime.safe_states['/actuator'] == stamp_of_step(opened)
    torque = recording.trajectory.clutch_torque[:, 0]
    assert torque[FROM_STEP - 1] > 50.0
    assert torque[-1] < 1.0
    scores = score_recording(recording, 'bag', packaged_limits()).scores
    assert not scores.valid
    assert f'/actuator at {opened / 100:g} s' in scores.safe_state
    assert scores.safe_state in scores.reason


FALSE_VALUES: dict[str, tuple[Any, ...]] = {
    '/engine/torque': (0.0,),
    '/load/torque': (1e4,),
    '/clutch/torque_request': (1e4,),
    '/actuator/torque': ([1e4] * 11,),
    '/clutch/torque': ([1e4] * 11,),
}


def test_replies_stamped_in_the_future_change_nothing(graph_of: GraphOf) -> None:
    run = plan(mode='realtime', duration_s=0.6)
    graph = graph_of(run)
    graph.add_all()
    owner = graph.driveline.owner
    publishers = {
        publisher.topic_name: publisher
        for node in graph.nodes.values()
        for publisher in node.publishers
    }
    graph.spin_until(lambda: owner.step >= FROM_STEP, f'step {FROM_STEP}')
    topics = {topic.resolved_name: topic for topic in TOPICS}
    for step in FUTURE_STEPS:
        for name, values in FALSE_VALUES.items():
            publishers[name].publish(topics[name].message(stamp_of_step(step), *values))
    graph.run()
    recording = read_bag(graph.folder)
    assert recording.missed == {}
    assert recording.realtime.safe_states == {}
    assert recording.trajectory.sha256() == expected(run).sha256()
    timing = read_timing(graph.folder)
    assert timing is not None
    assert timing.refused_messages == len(FUTURE_STEPS) * len(FALSE_VALUES)


def test_a_tick_stamped_in_the_future_opens_the_clutch_and_the_run_is_not_valid(
    graph_of: GraphOf,
) -> None:
    graph = graph_of(plan(mode='realtime', duration_s=0.9))
    graph.add_all()
    owner = graph.driveline.owner
    graph.spin_until(lambda: owner.step >= FROM_STEP, f'step {FROM_STEP}')
    publishers = {each.topic_name: each for each in graph.driveline.publishers}
    false = CLOCK.message(stamp_of_step(owner.step + 60))
    publishers[CLOCK.resolved_name].publish(false)
    graph.run()
    recording = read_bag(graph.folder)
    assert '/driveline' in recording.realtime.safe_states
    torque = recording.trajectory.joint_effort[:, 1]
    assert torque[FROM_STEP] > 50.0
    assert torque[-1] == 0.0
    assert not score_recording(recording, 'bag', packaged_limits()).scores.valid


def test_the_driveline_opens_the_clutch_itself_when_the_actuator_is_gone(
    graph_of: GraphOf, capfd: pytest.CaptureFixture[str]
) -> None:
    graph = graph_of(plan(mode='realtime', duration_s=0.9))
    graph.add_all()
    owner = graph.driveline.owner
    graph.spin_until(lambda: owner.step >= FROM_STEP and CLUTCH not in owner.missing(), 'a torque')
    last = owner.step
    graph.remove('actuator')
    graph.run()
    recording = read_bag(graph.folder)
    opened = last + round(CLUTCH_TIMEOUT_S / PERIOD_S) + 1
    assert recording.realtime.safe_states == {'/driveline': stamp_of_step(opened + 1)}
    torque = recording.trajectory.joint_effort[:, 1]
    held = torque[last + 1]
    assert held > 50.0
    assert np.all(torque[last + 1 : opened + 1] == held)
    ramp = held - FAIL_SAFE.fail_safe_ramp_n_m_s * PERIOD_S * np.arange(len(torque) - opened)
    assert torque[opened:] == pytest.approx(np.maximum(ramp, 0.0))
    assert torque[-1] == 0.0
    assert 'no clutch/torque for longer than clutch_timeout_s' in capfd.readouterr().err


def test_a_node_that_was_stopped_answers_again_when_it_goes_on(graph_of: GraphOf) -> None:
    """It then has the last ten messages in its queue."""
    graph = graph_of(plan(mode='realtime', duration_s=2.5))
    stopped = [step for step in range(251) if step % 100 >= 50]
    add_silent(graph, 'vehicle/twist', 'load', stopped)
    add_silent(graph, 'actuator/torque', 'clutch', stopped)
    graph.add_all()
    owner = graph.driveline.owner
    assert isinstance(owner, RealtimeOwner)
    for missed, steps in ((0, 50), (50, 100), (50, 150), (100, 200), (100, 250)):
        graph.spin_until(partial(lambda step: owner.step == step, steps), f'step {steps}')
        assert (owner.missed_replies[LOAD], owner.missed_replies[CLUTCH]) == (missed, missed)
