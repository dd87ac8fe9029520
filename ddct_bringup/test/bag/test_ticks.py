# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Complete ticks are found by stamps, and a missing or misplaced message is named."""

import pytest
from made_run import made_facts
from refusals import refused

from ddct_bringup.bag.ticks import check_ticks, last_whole_tick, tick_topics
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import (
    CLOCK,
    SENSED_TOPICS,
    SHIFT_TOPICS,
    SLIP,
    TOPICS,
    recorded_topics,
    tick_names,
)

LOCKSTEP, REALTIME = RunKind(), RunKind(lockstep=False)


def stamps_of(steps=5):
    names = tick_topics(LOCKSTEP, replies=True)
    return {name: [stamp_of_step(k) for k in range(steps + 1)] for name in names}


def test_a_complete_recording_is_accepted():
    assert check_ticks(stamps_of(5), LOCKSTEP) == 5


@pytest.mark.parametrize('step', [0, 2, 5])
def test_a_missing_reply_is_named_with_its_step(step):
    stamps = stamps_of(5)
    stamps['/load/torque'].remove(stamp_of_step(step))
    with pytest.raises(DdctError, match=f'/load/torque has no message at step {step} '):
        check_ticks(stamps, LOCKSTEP)


def test_a_missing_reply_is_no_error_in_real_time():
    stamps = stamps_of(5)
    stamps['/load/torque'].remove(stamp_of_step(2))
    assert check_ticks(stamps, REALTIME) == 5


@pytest.mark.parametrize('lockstep', [True, False])
def test_a_gap_in_the_states_is_an_error_in_every_mode(lockstep):
    stamps = stamps_of(5)
    for topic in stamps:
        stamps[topic].remove(stamp_of_step(3))
    with refused(DdctError, '/clock'):
        check_ticks(stamps, RunKind(lockstep))


@pytest.mark.parametrize('lockstep', [True, False])
def test_a_doubled_message_is_an_error_in_every_mode(lockstep):
    stamps = stamps_of(5)
    stamps['/clutch/torque'].append(stamp_of_step(4))
    with pytest.raises(DdctError, match='/clutch/torque has 2 messages at step 4 '):
        check_ticks(stamps, RunKind(lockstep))


def test_a_reply_after_the_last_tick_is_an_error():
    stamps = stamps_of(5)
    stamps['/clutch/torque'].append(stamp_of_step(6))
    with pytest.raises(DdctError, match='/clutch/torque goes on after the last tick at step 5 '):
        check_ticks(stamps, LOCKSTEP)


def test_a_stamp_off_the_grid_is_an_error():
    stamps = stamps_of(5)
    stamps['/clutch/torque'][2] += 1
    with pytest.raises(DdctError, match='/clutch/torque: stamp 1020000001 ns'):
        check_ticks(stamps, LOCKSTEP)


def test_a_topic_without_any_message_is_an_error():
    stamps = stamps_of(5)
    del stamps['/clutch/torque']
    with pytest.raises(DdctError, match='no message on /clutch/torque'):
        check_ticks(stamps, LOCKSTEP)


def test_the_last_whole_tick_is_that_before_the_first_hole():
    stamps = stamps_of(5)
    stamps['/recorder/ack'].remove(stamp_of_step(3))
    assert last_whole_tick(stamps, LOCKSTEP) == stamp_of_step(2)
    assert last_whole_tick(stamps, REALTIME) == stamp_of_step(5)


@pytest.mark.parametrize('lockstep', [True, False])
def test_a_recording_without_a_whole_tick_is_refused(lockstep):
    stamps = stamps_of(5)
    stamps['/clock'].remove(stamp_of_step(0))
    with pytest.raises(DdctError, match='ends before its first tick'):
        last_whole_tick(stamps, RunKind(lockstep))
    with pytest.raises(DdctError, match='ends before its first tick'):
        last_whole_tick({}, RunKind(lockstep))


def test_engine_torque_request_is_needed_once_it_was_recorded():
    assert '/engine/torque_request' not in tick_topics(LOCKSTEP, replies=True)
    two_input = RunKind(two_input=True)
    assert '/engine/torque_request' in tick_topics(two_input, replies=True)
    with refused(DdctError, '/engine/torque_request'):
        check_ticks(stamps_of(5), two_input)


@pytest.mark.parametrize('lacking', SENSED_TOPICS, ids=lambda topic: topic.name)
def test_one_topic_of_sensors_requires_the_others(lacking):
    names = [topic.resolved_name for topic in SENSED_TOPICS if topic is not lacking]
    run = made_facts().kind_of_bag({'/controller/torque_parts', names[0]})
    stamps = {**stamps_of(5), **{name: stamps_of(5)['/clutch/slip'] for name in names}}
    with refused(DdctError, lacking.resolved_name):
        check_ticks(stamps, run)
    assert made_facts().kind_of_bag({'/controller/torque_parts'}) == LOCKSTEP


def test_the_parts_of_the_torque_request_are_needed_once_one_was_recorded():
    without = made_facts().kind_of_bag(stamps_of(5).keys() - {'/controller/torque_parts'})
    stamps = {**stamps_of(5), '/controller/torque_parts': []}
    assert check_ticks(stamps, without) == 5
    with refused(DdctError, '/controller/torque_parts'):
        check_ticks(stamps, LOCKSTEP)


def test_topics_of_a_shift_are_needed_in_runs_of_a_shift_only():
    names = {
        f'off_going/{name}'
        for name in (
            'run_info',
            'joint_states',
            'clutch/slip',
            'clutch/phase',
            'clutch/torque_request',
            'actuator/torque',
            'clutch/torque',
            'clutch/temperature',
        )
    } | {'clutch/handover_share', 'engine/torque_cut'}
    assert {topic.name for topic in SHIFT_TOPICS} == names
    others = {topic.name for topic in recorded_topics(RunKind(clutch='stick_slip'))}
    shift = RunKind(clutch='stick_slip', shift=True)
    assert {topic.name for topic in recorded_topics(shift)} == others | names
    assert made_facts().kind_of_bag({'/controller/torque_parts'}) == LOCKSTEP
    for name in names:
        found = made_facts().kind_of_bag({'/controller/torque_parts', f'/{name}'})
        assert found == RunKind(shift=True)


def test_a_lock_step_recording_holds_no_wall_clock_topic():
    names = {topic.name for topic in recorded_topics(RunKind(two_input=True))}
    assert names.isdisjoint({'controller/timing', '/diagnostics'})
    everything = RunKind(False, True, 'stick_slip', sensed=True, shift=True)
    assert {topic.name for topic in recorded_topics(everything)} == {
        topic.name for topic in TOPICS
    }


def test_every_tick_begins_with_the_clock_and_ends_with_the_acknowledgement():
    names = [topic.name for topic in recorded_topics(LOCKSTEP) if topic.every_tick]
    assert names == [
        '/clock',
        'driveline/joint_states',
        'clutch/slip',
        'vehicle/twist',
        'vehicle/accel',
        'engine/torque_demand',
        'engine/torque',
        'load/torque',
        'clutch/slip_reference',
        'controller/status',
        'clutch/torque_request',
        'controller/torque_parts',
        'actuator/torque',
        'clutch/torque',
        'recorder/ack',
    ]
    of_sensors = {'sensors/joint_states', 'sensors/slip', 'sensors/twist', 'sensors/status'}
    off_going = {f'off_going/{name}' for name in ('joint_states', 'clutch/slip', 'clutch/phase')}
    assert tick_names() == {*names[:5], 'clutch/phase', *of_sensors, *off_going}
    assert SLIP.resolved_name == '/clutch/slip'
    assert CLOCK.resolved_name == '/clock'
