# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Validity of runs, and the summary of a real-time run."""

from dataclasses import replace
from pathlib import Path

import pytest
from made_run import made_facts

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.recording import Recording
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.scores.validity import realtime_summary, why_invalid
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.graph.node_names import StatusName
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

STEPS = 300
TOLERATED = 3
COUNTS = {'steps': '300', 'missed_steps': '4', 'resends': '5', 'late_messages': '6'}
SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
TRAJECTORY = run_headless(SETTINGS, 'ls8')


def facts(**values):
    given = RealtimeFacts(steps=STEPS, lateness_us=[3.5, 412.0, 80.0])
    return replace(given, **values)


def recording(
    realtime=None, *, missed=None, mode='realtime', duration_s=3.0, path=Path('bag.mcap')
):
    return Recording(
        path=path,
        trajectory=TRAJECTORY,
        facts=made_facts(mode=mode, duration_s=duration_s, score_window_s=(0.6, 3.0)),
        custom_data={},
        run_info={},
        missed=missed or {},
        realtime=realtime or facts(),
    )


def scored(run):
    return score_recording(run, 'bag', packaged_limits()).scores


@pytest.mark.parametrize('mode', ['lockstep', 'realtime'])
def test_a_whole_run_counts(mode):
    assert TRAJECTORY.steps == STEPS
    assert why_invalid(recording(mode=mode)) == ''


@pytest.mark.parametrize('mode', ['lockstep', 'realtime'])
def test_a_run_one_step_short_does_not_count(mode):
    reason = why_invalid(recording(facts(steps=200), mode=mode, duration_s=3.01))
    why = ': the driveline last counted at step 200' if mode == 'realtime' else ''
    assert reason == f'ended early: 300 of 301 steps{why}'


def test_a_run_whose_last_tick_is_not_recorded_has_that_as_its_reason():
    reason = why_invalid(recording(facts(steps=301), duration_s=3.01))
    assert reason == (
        'ended early: 300 of 301 steps: the driveline took them all, but the recorder did not '
        'receive the last'
    )


def test_misses_count_up_to_the_stated_tolerance():
    assert why_invalid(recording(facts(missed_steps=TOLERATED))) == ''
    reason = why_invalid(recording(facts(missed_steps=TOLERATED + 1)))
    assert reason == '4 of 300 steps held a torque for want of a reply, more than 3 (1 %)'


@pytest.mark.parametrize(
    'topic', ['engine/torque', 'load/torque', 'clutch/torque', 'off_going/clutch/torque']
)
def test_torques_that_the_bag_lacks_count_as_misses(topic):
    assert why_invalid(recording(missed={topic: TOLERATED})) == ''
    assert why_invalid(recording(missed={topic: TOLERATED + 1})).startswith('4 of 300 steps held')


@pytest.mark.parametrize('node', ['/actuator', '/engine', '/driveline'])
def test_a_safe_state_makes_a_run_invalid_and_is_named(node):
    since = {node: stamp_of_step(87)}
    run = scored(recording(facts(safe_states=since)))
    assert (run.valid, run.safe_state) == (False, f'{node} at 0.87 s')
    assert run.reason == f'safe state entered by {node} at 0.87 s'


def test_scores_have_the_safe_state_in_real_time_only():
    assert scored(recording()).safe_state == ''
    assert scored(recording(mode='lockstep')).safe_state is None


def test_scores_contain_the_worst_lateness_of_the_timing_file(tmp_path):
    RunTiming(missed_steps=2, lateness_us=[1500.0, 2.0]).write(tmp_path)
    metrics = scored(recording(path=tmp_path / 'x.mcap')).metrics
    assert (metrics['missed_steps'], metrics['worst_lateness_us']) == (2, 1500.0)


def test_the_summary_states_misses_lateness_and_safe_states_in_their_order():
    states = {'/driveline': stamp_of_step(95), '/actuator': stamp_of_step(90)}
    given = facts(missed_steps=2, safe_states=states)
    assert realtime_summary(recording(given)) == (
        '2 of 300 steps missed, worst lateness 0.41 ms, '
        'safe state: /actuator at 0.9 s, /driveline at 0.95 s'
    )
    assert realtime_summary(recording(facts(lateness_us=[]))) == (
        '0 of 300 steps missed, worst lateness unknown, safe state: none'
    )


def test_diagnostics_of_nodes_are_parsed():
    received = RealtimeFacts()
    assert received.receive(
        StatusName('/driveline', ': ticks'), {**COUNTS, 'tick_lateness_us': '12.5 700'}
    )
    assert received.receive(StatusName.of('actuator: safe state'), {'since_ns': '1870000000'})
    assert received == RealtimeFacts(
        *(4, 5, 6, {'/actuator': 1870000000}), lateness_us=[12.5, 700.0], steps=300
    )


@pytest.mark.parametrize(
    ('name', 'pairs'),
    [
        ('motor: temperature', {'steps': '1'}),
        ('temperature', {'since_ns': '1'}),
        ('safe state', {'since_ns': '1'}),
        ('/car8/driveline: ticks', COUNTS),
        ('driveline: ticks', {}),
        ('driveline: ticks', {'steps': 'many'}),
        ('actuator: safe state', {}),
        ('actuator: safe state', {'since_ns': 'now'}),
    ],
)
def test_diagnostics_of_other_nodes_are_ignored(name, pairs):
    received = RealtimeFacts()
    assert not received.receive(StatusName.of(name), pairs)
    assert received == RealtimeFacts()
