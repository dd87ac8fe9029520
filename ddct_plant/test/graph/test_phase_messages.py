# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Phases, capacities and temperature on the wire: what goes in comes out, the rest is refused."""

import pytest
from refusals import refused

pytest.importorskip('trajectory_msgs.msg', reason='needs the ROS message types')

from ddct_plant.base.errors import DdctError  # noqa: E402
from ddct_plant.base.timebase import stamp_of_step  # noqa: E402
from ddct_plant.models.driveline import PhaseEvent  # noqa: E402
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import (
    CLUTCH_PHASE,
    CLUTCH_TEMPERATURE,
    CLUTCH_TORQUE,
    HOLDING_TORQUE,
    OFF_GOING_PHASE,
)

STAMP, LATER = stamp_of_step(123), stamp_of_step(124)
LOCKS = (PhaseEvent(0.5, 'lock', -62.5),)
LOW, HIGH = [10.0 + i / 3.0 for i in range(11)], [12.0 + i / 3.0 for i in range(11)]


def test_phase_work_and_events_come_back_to_the_last_bit():
    write = CLUTCH_PHASE.writer()
    events = (
        PhaseEvent(1.2345678901234567, 'release', 0.0),
        PhaseEvent(0.1 + 1.13, 'lock', -200.0 / 3.0),
        PhaseEvent(1.2345, 'reverse'),
    )
    for values in ((1.0, 1.0 / 3.0, events), (2.0, 0.0, ()), (0.0, 1e-17, events[:1])):
        message = write(STAMP, *values)
        assert CLUTCH_PHASE.values(message) == values
        assert all(isinstance(each, PhaseEvent) for each in CLUTCH_PHASE.values(message)[2])
        assert CLUTCH_PHASE.read(message) == values[1]


def test_the_phase_is_a_word_and_each_event_comes_before_its_slip_acceleration():
    message = CLUTCH_PHASE.message(STAMP, 1.0, 0.25, LOCKS)
    pairs = [(pair.key, pair.value) for pair in message.status[0].values]
    assert pairs == [
        ('phase', 'slipping'),
        ('friction_work_j', '0.25'),
        ('lock', '0.5'),
        ('slip_acceleration_rad_s2', '-62.5'),
    ]


def test_the_report_on_the_off_going_clutch_has_the_tie_up_work_too():
    values = (1.0, 0.25, 1.0 / 3.0, LOCKS)
    message = OFF_GOING_PHASE.message(STAMP, *values)
    pairs = [(pair.key, pair.value) for pair in message.status[0].values]
    assert pairs[1:3] == [('friction_work_j', '0.25'), ('tie_up_work_j', repr(1.0 / 3.0))]
    assert OFF_GOING_PHASE.values(message) == values
    # The node of the off-going clutch reads it as that of its clutch.
    assert CLUTCH_PHASE.values(message) == (1.0, 0.25, LOCKS)
    assert CLUTCH_PHASE.read(message) == 0.25
    with pytest.raises(LookupError, match='its status holds'):
        OFF_GOING_PHASE.values(CLUTCH_PHASE.message(STAMP, 1.0, 0.25, LOCKS))


def test_events_of_bags_recorded_before_have_no_slip_acceleration():
    message = CLUTCH_PHASE.message(STAMP, 1.0, 0.25, LOCKS)
    message.status[0].values = message.status[0].values[:3]
    assert CLUTCH_PHASE.values(message)[2] == (PhaseEvent(0.5, 'lock', None),)


@pytest.mark.parametrize(
    ('place', 'key', 'value'),
    [
        (0, 'phase', 'melted'),
        (1, 'friction_work_j', 'much'),
        (1, 'friction_work_j', '-1.0'),
        (1, 'friction_work_j', 'nan'),
        (1, 'work', '1.0'),
        (2, 'lock', 'soon'),
        (2, 'bounce', '0.5'),
        (2, 'slip_acceleration_rad_s2', '1.0'),
        (3, 'slip_acceleration_rad_s2', 'fast'),
        (3, 'slip_acceleration', '1.0'),
    ],
)
def test_a_report_that_is_none_is_refused(place, key, value):
    message = CLUTCH_PHASE.message(STAMP, 1.0, 0.25, LOCKS)
    pair = message.status[0].values[place]
    pair.key, pair.value = key, value
    with refused(DdctError, 'clutch/phase'):
        CLUTCH_PHASE.read(message)


def test_the_two_capacities_are_two_joints():
    message = CLUTCH_TORQUE.message(STAMP, LOW, HIGH)
    assert list(message.joint_names) == ['clutch', 'clutch_static']
    assert [list(point.effort) for point in message.points] == [
        [low, high] for low, high in zip(LOW, HIGH, strict=True)
    ]
    assert CLUTCH_TORQUE.values(message) == (LOW, HIGH)
    assert CLUTCH_TORQUE.read(message, joints=2) == (LOW, HIGH)


def test_a_clutch_of_another_kind_of_run_is_refused():
    linear, stick_slip = CLUTCH_TORQUE.message(STAMP, LOW), CLUTCH_TORQUE.message(STAMP, LOW, HIGH)
    with pytest.raises(DdctError, match='has the joints clutch: this run needs clutch, clutch_st'):
        CLUTCH_TORQUE.read(linear, joints=2)
    with pytest.raises(DdctError, match='clutch, clutch_static: this run needs clutch; start ev'):
        CLUTCH_TORQUE.read(stick_slip)


@pytest.mark.parametrize(
    ('low', 'high', 'complaint'),
    [(LOW, LOW[::-1], 'below the kinetic'), ([-1.0] * 11, HIGH, 'not be negative')],
)
def test_capacities_that_cannot_be_are_refused(low, high, complaint):
    with pytest.raises(DdctError, match=f'^clutch/torque: .*{complaint}'):
        CLUTCH_TORQUE.read(CLUTCH_TORQUE.message(STAMP, low, high), joints=2)


def test_a_negative_holding_torque_is_refused():
    with refused(DdctError, key='load/holding_torque'):
        HOLDING_TORQUE.read(HOLDING_TORQUE.message(STAMP, -1.0))


def test_the_temperature_is_in_its_field():
    assert CLUTCH_TEMPERATURE.message(LATER, 123.25).temperature == 123.25


def test_only_stick_slip_runs_have_a_static_capacity():
    names = [
        [signal.name for signal in CLUTCH_TORQUE.signals_in(RunKind(clutch=clutch))]
        for clutch in ('linear', 'stick_slip')
    ]
    assert names == [['clutch_torque'], ['clutch_torque', 'clutch_static_torque']]
