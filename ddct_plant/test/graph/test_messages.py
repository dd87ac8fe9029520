"""Every message that is made reads back as what went into it, and so do reused ones."""

import pytest

rclpy_messages = pytest.importorskip('trajectory_msgs.msg', reason='needs the ROS message types')

from ddct_plant.base.timebase import stamp_of_step  # noqa: E402
from ddct_plant.graph import messages  # noqa: E402
from ddct_plant.graph.message_values import JOINTS, NS_PER_S  # noqa: E402

STAMP = stamp_of_step(123)
LATER = stamp_of_step(124)
POINTS = [float(i) / 3.0 for i in range(11)]


@pytest.mark.parametrize(
    'message',
    [
        messages.stamp_message(STAMP),
        messages.clock_message(STAMP),
        messages.ack_message(STAMP),
        messages.joint_states_message(STAMP, [0.0] * 4, [0.0] * 4, [0.0] * 4),
        messages.slip_message(STAMP, 1.0),
        messages.twist_message(STAMP, 1.0),
        messages.accel_message(STAMP, 1.0),
        messages.torque_message(STAMP, 1.0),
        messages.torque_points_message(STAMP, POINTS),
        messages.slip_reference_message(STAMP, [1.0], [2.0]),
        messages.status_message(STAMP, 'x', []),
    ],
    ids=lambda message: type(message).__name__,
)
def test_every_kind_carries_its_stamp(message):
    assert messages.stamp_ns(message) == STAMP


@pytest.mark.parametrize(
    ('make', 'read'),
    [
        (messages.slip_message, messages.slip_of),
        (messages.twist_message, messages.vehicle_speed_of),
        (messages.accel_message, messages.vehicle_accel_of),
        (messages.torque_message, messages.torque_of),
    ],
)
def test_single_values_come_back_to_the_last_bit(make, read):
    first = make(STAMP, 0.1)
    assert read(first) == 0.1
    again = make(LATER, -1.0 / 3.0, reuse=first)
    assert again is first
    assert (read(again), messages.stamp_ns(again)) == (-1.0 / 3.0, LATER)


def test_joint_states_are_named_and_never_leave_an_array_empty():
    first = messages.joint_states_message(STAMP, [1.0, 2, 3, 4], (5, 6, 7, 8), [9, 10, 11, 12])
    assert tuple(first.name) == JOINTS
    assert list(first.position) == [1.0, 2.0, 3.0, 4.0]
    assert list(first.velocity) == [5.0, 6.0, 7.0, 8.0]
    assert list(first.effort) == [9.0, 10.0, 11.0, 12.0]
    again = messages.joint_states_message(LATER, [0.0] * 4, [1.0] * 4, [2.0] * 4, reuse=first)
    assert again is first
    assert list(again.effort) == [2.0] * 4


def test_torque_points_are_1_ms_apart():
    message = messages.torque_points_message(STAMP, POINTS)
    assert message.joint_names == ['clutch']
    assert messages.torque_points_of(message) == POINTS
    times = [point.time_from_start for point in message.points]
    assert [time.sec * NS_PER_S + time.nanosec for time in times] == [
        i * 1_000_000 for i in range(11)
    ]


def test_torque_points_are_filled_anew():
    kept = messages.TorquePointsMessage()
    first = kept.fill(STAMP, POINTS)
    assert kept.fill(LATER, POINTS[::-1]) is first
    assert messages.torque_points_of(first) == POINTS[::-1]
    assert messages.stamp_ns(first) == LATER


@pytest.mark.parametrize('count', [10, 12])
def test_another_number_of_torque_points_is_an_error(count):
    with pytest.raises(ValueError, match='zip'):
        messages.torque_points_message(STAMP, [0.0] * count)


def test_slip_reference_is_10_ms_apart():
    speeds, rates = [float(i) for i in range(150)], [-float(i) for i in range(150)]
    message = messages.slip_reference_message(STAMP, speeds, rates)
    assert message.joint_names == ['clutch_slip']
    assert messages.slip_reference_of(message) == (speeds, rates)
    last = message.points[-1].time_from_start
    assert (last.sec, last.nanosec) == (1, 490_000_000)


def test_slip_reference_is_filled_anew():
    kept = messages.SlipReferenceMessage(preview_steps=2)
    first = kept.fill(STAMP, [1.0, 2.0, 3.0], [4.0, 5.0, 6.0])
    assert kept.fill(LATER, [0.0, 0.5, 1.0], [2.0, 2.0, 2.0]) is first
    assert messages.slip_reference_of(first) == ([0.0, 0.5, 1.0], [2.0, 2.0, 2.0])
    with pytest.raises(ValueError, match='zip'):
        kept.fill(STAMP, [1.0], [1.0])


def test_status_pairs_come_back_in_order():
    message = messages.status_message(STAMP, 'controller', [('b', '1'), ('a', '2')])
    assert messages.status_name_of(message) == 'controller'
    assert messages.status_pairs_of(message) == (('b', '1'), ('a', '2'))


def test_status_is_filled_anew_with_more_or_fewer_pairs():
    kept = messages.StatusMessage('controller')
    first = kept.fill(STAMP, [('a', '1'), ('b', '2')])
    for pairs in (
        (('a', '3'), ('c', '4')),
        (('a', '5'),),
        (('a', '6'), ('b', '7'), ('d', '8')),
        (),
    ):
        assert kept.fill(LATER, pairs) is first
        assert messages.status_name_of(first) == 'controller'
        assert messages.status_pairs_of(first) == pairs
    assert messages.stamp_ns(first) == LATER
