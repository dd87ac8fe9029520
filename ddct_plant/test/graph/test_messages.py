# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every message that is made reads back as what went into it, and so do reused ones."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from refusals import refused

rclpy_messages = pytest.importorskip('trajectory_msgs.msg', reason='needs the ROS message types')

import diagnostic_msgs.msg as rclpy_diagnostics  # noqa: E402

from ddct_plant.base.errors import MOST_SIGNAL, DdctError  # noqa: E402
from ddct_plant.base.timebase import stamp_of_step  # noqa: E402
from ddct_plant.models.driveline import JointValues  # noqa: E402
from ddct_plant.shift.balance import WHOLE  # noqa: E402
from ddct_plant.signals import topics  # noqa: E402
from ddct_plant.signals.message_kind import NS_PER_S, Numbers, stamp_ns  # noqa: E402

STAMP = stamp_of_step(123)
LATER = stamp_of_step(124)
POINTS = [float(i) / 3.0 for i in range(11)]
VALUES = {
    'run_info': ([],),
    'driveline/joint_states': ([0.0] * 4, [1.0] * 4, [2.0] * 4),
    'sensors/joint_states': ([1.0] * 3,),
    'sensors/status': ([0.0] * 3, 0.0, 1.0),
    'clutch/slip_reference': ([1.0], [2.0]),
    'controller/status': ([],),
    'controller/timing': ([],),
    '/diagnostics': ([],),
    'actuator/torque': (POINTS,),
    'clutch/torque': (POINTS,),
    'clutch/phase': (1.0, 0.5, ()),
    'off_going/clutch/phase': (1.0, 0.5, 0.25, ()),
}
"""Values of a topic; one number per signal for the topics that are not listed."""


def values_of(topic):
    """Return values for a topic; those of the off-going side are like those of the other."""
    same = VALUES.get(topic.name.removeprefix('off_going/'), [1.0] * len(topic.signals))
    return VALUES.get(topic.name, same)


SCALARS = [
    topic
    for topic in topics.TOPICS
    if isinstance(topic.kind, Numbers) and len(topic.kind.numbers) == 1
]
WITHOUT_FRAME = {'Clock', 'Header', 'DiagnosticArray'}
"""Types whose values have no coordinate frame."""


@pytest.mark.parametrize('topic', topics.TOPICS, ids=lambda topic: topic.name)
def test_every_topic_carries_its_stamp(topic):
    message = topic.message(STAMP, *values_of(topic))
    assert isinstance(message, topic.message_class)
    assert stamp_ns(message) == STAMP


@pytest.mark.parametrize('topic', SCALARS, ids=lambda topic: topic.name)
def test_single_values_come_back_to_the_last_bit(topic):
    write = topic.writer()
    first = write(STAMP, 0.1)
    assert (topic.read(first), topic.values(first)) == (0.1, (0.1,))
    value = -1.0 / 3.0 if topic.kind.numbers[0].at_least is None else 1.0 / 3.0
    again = write(LATER, value)
    assert again is first
    assert (topic.read(again), stamp_ns(again)) == (value, LATER)


@pytest.mark.parametrize('topic', topics.TOPICS, ids=lambda topic: topic.name)
def test_every_value_with_coordinates_has_a_frame(topic):
    """REP-105 has `base_link`; the others turn with the part that they are named after."""
    message = topic.message(STAMP, *values_of(topic))
    frames = {'base_link', 'engine_link', 'clutch_link', 'wheel_link'}
    if topic.type.rpartition('/')[2] in WITHOUT_FRAME:
        assert getattr(getattr(message, 'header', message), 'frame_id', '') == topic.frame == ''
    else:
        assert message.header.frame_id == topic.frame
        assert topic.frame in frames


def test_the_frame_of_a_sensor_is_that_of_the_true_signal():
    for sensed, true in (
        (topics.SENSED_JOINT_STATES, topics.JOINT_STATES),
        (topics.SENSED_SLIP, topics.SLIP),
        (topics.SENSED_VEHICLE_SPEED, topics.VEHICLE_SPEED),
        (topics.SENSED_ENGINE_TORQUE, topics.ENGINE_TORQUE),
    ):
        assert sensed.frame == true.frame


def test_the_off_going_shaft_has_angle_speed_and_torque_and_its_name():
    topic = topics.OFF_GOING_JOINT_STATES
    message = topic.message(STAMP, 1.0, 2.0, -3.0)
    assert topic.values(message) == (1.0, 2.0, -3.0)
    message.name = ['wheel']
    with pytest.raises(DdctError, match='primary_shaft'):
        topic.values(message)


@pytest.mark.parametrize('topic', [topics.OFF_GOING_JOINT_STATES, topics.TORQUE_PARTS])
@pytest.mark.parametrize('change', [lambda row: [*row, 0.0], lambda row: row[:-1]])
def test_named_values_need_one_number_for_each_name(topic, change):
    message = topic.message(STAMP, 1.0, 2.0, 3.0)
    assert topic.values(message) == (1.0, 2.0, 3.0)
    message.effort = change(list(message.effort))
    with pytest.raises(DdctError, match=f'has {len(message.effort)} numbers in effort'):
        topic.values(message)


def test_a_torque_whose_name_comes_twice_is_refused():
    message = topics.TORQUE_PARTS.message(STAMP, 1.0, 2.0, 3.0)
    message.name, message.effort = [*message.name, 'closing'], [*message.effort, 4.0]
    with pytest.raises(DdctError, match='a name comes twice'):
        topics.TORQUE_PARTS.values(message)


NUMBERS: dict[str, Callable[[float], Any]] = {
    **{topic.name: lambda value: (value,) for topic in SCALARS},
    'driveline/joint_states': lambda value: ([0.0] * 4, [1.0, value, 2.0, 3.0], [2.0] * 4),
    'sensors/joint_states': lambda value: ([1.0, 2.0, value],),
    'clutch/torque': lambda value: ([*POINTS[:-1], value],),
    'clutch/slip_reference': lambda value: ([1.0], [value]),
    'clutch/handover_share': lambda value: (0.5, value, 0.0),
}
"""Values of a topic, by its name, with a number among them."""


@pytest.mark.parametrize('value', [math.nan, -math.inf, 1.1 * MOST_SIGNAL, 1e308])
@pytest.mark.parametrize('name', NUMBERS)
def test_a_number_that_no_signal_has_is_refused_with_the_topic(name, value):
    topic = next(each for each in topics.TOPICS if each.name == name)
    topic.read(topic.message(STAMP, *NUMBERS[name](0.25)))
    with refused(DdctError, name):
        topic.read(topic.message(STAMP, *NUMBERS[name](value)))


@pytest.mark.parametrize(
    'values',
    [
        (-0.1, 0.0, 0.0),
        (1.1, 0.0, 0.0),
        (0.5, -0.95, 0.0),
        (0.5, 0.0, math.nan),
    ],
)
def test_a_share_of_the_handover_out_of_its_bounds_is_refused(values):
    with refused(DdctError, key='clutch/handover_share'):
        topics.HANDOVER_SHARE.read(topics.HANDOVER_SHARE.message(STAMP, *values))


def test_a_share_comes_with_what_is_known_of_the_clutch():
    message = topics.HANDOVER_SHARE.message(STAMP, 0.5, -0.2, 8.0)
    assert topics.HANDOVER_SHARE.values(message) == (0.5, -0.2, 8.0)
    assert topics.HANDOVER_SHARE.read(message).request(80.0) == pytest.approx(90.0)


def test_a_share_alone_corrects_no_request():
    """As a node of a third party publishes it that knows of nothing else."""
    message = topics.HANDOVER_SHARE.message(STAMP, 1.0, 0.0, 0.0)
    assert topics.HANDOVER_SHARE.read(message) == WHOLE


def test_a_lost_sample_is_a_stale_status_of_its_name():
    write = topics.SENSOR_STATUS.writer()
    some = write(STAMP, [0.0, 1.0, 0.0], 1.0, 0.0)
    names = ['engine', 'primary_shaft', 'wheel', 'slip', 'vehicle']
    assert [each.name for each in some.status] == names
    stale = rclpy_diagnostics.DiagnosticStatus.STALE
    assert [each.level == stale for each in some.status] == [False, True, False, True, False]
    assert topics.SENSOR_STATUS.values(some) == ([0.0, 1.0, 0.0], 1.0, 0.0)
    none = write(LATER, [0.0] * 3, 0.0, 0.0)
    assert topics.SENSOR_STATUS.values(none) == ([0.0] * 3, 0.0, 0.0)
    estimate = topics.ENGINE_SENSOR_STATUS
    assert estimate.values(estimate.message(STAMP, 1.0)) == (1.0,)
    none.status = none.status[:-1]
    with pytest.raises(LookupError, match='vehicle'):
        topics.SENSOR_STATUS.values(none)


def test_sensed_joints_have_speeds_alone_and_leave_no_array_empty_at_the_end():
    topic = topics.SENSED_JOINT_STATES
    write = topic.writer()
    some = write(STAMP, [1.0, 2.0, 3.0])
    assert list(some.name) == ['engine', 'primary_shaft', 'wheel']
    assert tuple(topic.read(some)) == (1.0, 2.0, 3.0)
    assert topic.read(some).primary_shaft == 2.0
    assert [list(each) for each in topic.values(some)] == [[1.0, 2.0, 3.0]]
    assert len(some.effort) == 3
    assert all(math.isnan(each) for each in some.effort)
    with refused(DdctError, key='sensors/joint_states'):
        topic.read(write(LATER, [1.0, math.inf, 3.0]))
    some.name = ['engine', 'wheel', 'primary_shaft']
    with refused(DdctError, 'sensors/joint_states'):
        topic.read(some)


def test_the_parts_of_the_request_are_numbers_by_name():
    topic = topics.TORQUE_PARTS
    message = topic.message(STAMP, 0.1, -1.0 / 3.0, 0.0)
    assert dict(zip(message.name, message.effort, strict=True)) == {
        'open_loop': 0.1,
        'closed_loop': -1.0 / 3.0,
        'closing': 0.0,
    }
    message.name = ['closing', 'open_loop', 'closed_loop']
    assert topic.values(message) == (-1.0 / 3.0, 0.0, 0.1)
    message.name, message.effort = ['closing', 'open_loop'], [0.1, 0.0]
    with pytest.raises(DdctError, match='closing, open_loop, not open_loop, closed_loop'):
        topic.values(message)


@pytest.mark.parametrize(
    ('topic', 'field'),
    [
        (topics.SLIP, lambda message: message.twist.angular.x),
        (topics.VEHICLE_SPEED, lambda message: message.twist.linear.x),
        (topics.VEHICLE_ACCEL, lambda message: message.accel.linear.x),
        (topics.LOAD_TORQUE, lambda message: message.wrench.torque.x),
    ],
)
def test_single_values_are_in_the_field_of_the_interfaces_page(topic, field):
    assert field(topic.message(STAMP, 0.1)) == 0.1


def test_joint_states_are_named_and_never_leave_an_array_empty():
    write = topics.JOINT_STATES.writer()
    first = write(STAMP, [1.0, 2, 3, 4], (5, 6, 7, 8), [9, 10, 11, 12])
    assert tuple(first.name) == JointValues._fields
    assert list(first.position) == [1.0, 2.0, 3.0, 4.0]
    assert list(first.velocity) == [5.0, 6.0, 7.0, 8.0]
    assert list(first.effort) == [9.0, 10.0, 11.0, 12.0]
    again = write(LATER, [0.0] * 4, [1.0] * 4, [2.0] * 4)
    assert again is first
    assert list(again.effort) == [2.0] * 4


def test_joint_states_of_other_joints_are_an_error():
    message = topics.JOINT_STATES.message(STAMP, [0.0] * 4, [0.0] * 4, [0.0] * 4)
    message.name = ['wheel']
    with pytest.raises(DdctError, match='the joints are wheel, not engine, primary_shaft'):
        topics.JOINT_STATES.values(message)
    with refused(DdctError, 'driveline/joint_states'):
        topics.JOINT_STATES.read(message)


def test_torque_points_are_1_ms_apart():
    message = topics.CLUTCH_TORQUE.message(STAMP, POINTS)
    assert message.joint_names == ['clutch']
    assert topics.CLUTCH_TORQUE.values(message) == (POINTS,)
    times = [point.time_from_start for point in message.points]
    assert [time.sec * NS_PER_S + time.nanosec for time in times] == [
        i * 1_000_000 for i in range(11)
    ]


def test_torque_points_are_filled_anew():
    write = topics.CLUTCH_TORQUE.writer()
    first = write(STAMP, POINTS)
    assert write(LATER, POINTS[::-1]) is first
    assert topics.CLUTCH_TORQUE.read(first) == (POINTS[::-1],)
    assert stamp_ns(first) == LATER


@pytest.mark.parametrize('count', [10, 12])
def test_another_number_of_torque_points_is_an_error(count):
    with pytest.raises(ValueError, match='zip'):
        topics.CLUTCH_TORQUE.message(STAMP, [0.0] * count)


def test_slip_reference_is_10_ms_apart():
    speeds, rates = [float(i) for i in range(150)], [-float(i) for i in range(150)]
    message = topics.SLIP_REFERENCE.message(STAMP, speeds, rates)
    assert message.joint_names == ['clutch_slip']
    assert topics.SLIP_REFERENCE.values(message) == (speeds, rates)
    last = message.points[-1].time_from_start
    assert (last.sec, last.nanosec) == (1, 490_000_000)


@pytest.mark.parametrize('preview_steps', [0, 1, 3])
def test_a_preview_is_read_as_far_as_the_controller_needs(preview_steps):
    speeds, rates = [5.0, 4.0, 2.0, 1.0], [-100.0, -200.0, -100.0, -50.0]
    message = topics.SLIP_REFERENCE.message(STAMP, speeds, rates)
    ahead = preview_steps + 1
    found = topics.SLIP_REFERENCE.read(message, preview_steps=preview_steps)
    assert found == (speeds[:ahead], rates[:ahead])


@pytest.mark.parametrize('preview_steps', [4, 22])
def test_the_error_of_a_short_preview_names_the_length_it_needs(preview_steps):
    message = topics.SLIP_REFERENCE.message(STAMP, [5.0, 4.0, 3.0, 2.0], [0.0] * 4)
    words = f'has 4 points and the controller needs {preview_steps + 1}: .*:={preview_steps}$'
    with pytest.raises(DdctError, match=words):
        topics.SLIP_REFERENCE.read(message, preview_steps=preview_steps)


def test_slip_reference_is_filled_anew():
    write = topics.SLIP_REFERENCE.writer()
    first = write(STAMP, [1.0, 2.0, 3.0], [4.0, 5.0, 6.0])
    assert write(LATER, [0.0, 0.5, 1.0], [2.0, 2.0, 2.0]) is first
    assert topics.SLIP_REFERENCE.values(first) == ([0.0, 0.5, 1.0], [2.0, 2.0, 2.0])
    with pytest.raises(ValueError, match='zip'):
        write(STAMP, [1.0], [1.0])


def test_status_pairs_come_back_in_order():
    message = topics.RUN_INFO.message(STAMP, [('b', '1'), ('a', '2')], name='engine')
    assert message.status[0].name == 'engine'
    assert topics.RUN_INFO.values(message) == ((('b', '1'), ('a', '2')),)
    assert topics.RUN_INFO.read(message) == ('engine', {'b': '1', 'a': '2'})


def test_status_is_filled_anew_with_more_or_fewer_pairs():
    write = topics.CONTROLLER_STATUS.writer()
    first = write(STAMP, [('a', '1'), ('b', '2')])
    for pairs in (
        (('a', '3'), ('c', '4')),
        (('a', '5'),),
        (('a', '6'), ('b', '7'), ('d', '8')),
        (),
    ):
        assert write(LATER, pairs) is first
        assert first.status[0].name == 'controller'
        assert topics.CONTROLLER_STATUS.values(first) == (pairs,)
    assert stamp_ns(first) == LATER
