"""The driveline steps only on whole ticks, sends again, and gives up with a reason."""

import pytest

from ddct_plant.errors import DdctError
from ddct_plant.graph.tick_owner import (
    CLUTCH,
    ENGINE,
    LOAD,
    RECORDER_TOPIC,
    LockstepOwner,
    RealtimeOwner,
    TickPlan,
)
from ddct_plant.timebase import stamp_of_step

POINTS = [float(i) for i in range(11)]


class FakeDriveline:
    def __init__(self):
        self.steps = []

    def step(self, engine, load, clutch):
        self.steps.append((engine, load, list(clutch)))


class Harness:
    """An owner with a hand-driven clock; records what it publishes and how it ends."""

    def __init__(self, owner_type, steps=3, require_recorder=False):
        self.now = 0.0
        self.published = []
        self.ends = []
        self.driveline = FakeDriveline()
        self.owner = owner_type(
            self.driveline,
            TickPlan(steps, require_recorder, answer_timeout_s=1.0),
            self.published.append,
            self.ends.append,
            clock=lambda: self.now,
        )

    def answer(self, step, engine=1.0, topics=(ENGINE, LOAD, CLUTCH)):
        replies = {ENGINE: engine, LOAD: 2.0, CLUTCH: POINTS, RECORDER_TOPIC: None}
        for topic in topics:
            self.owner.offer(topic, stamp_of_step(step), replies[topic])


@pytest.fixture
def lockstep():
    return Harness(LockstepOwner)


@pytest.fixture
def realtime():
    harness = Harness(RealtimeOwner)
    harness.owner.start()
    harness.answer(0)
    return harness


def test_lockstep_runs_to_the_last_tick_and_ends_well(lockstep):
    lockstep.owner.start()
    for step in range(4):
        lockstep.answer(step)
    assert lockstep.published == [0, 1, 2, 3]
    assert lockstep.driveline.steps == [(1.0, 2.0, POINTS)] * 3
    assert lockstep.ends == [None]


def test_lockstep_never_steps_on_a_reply_to_another_tick(lockstep):
    lockstep.owner.start()
    lockstep.answer(0)
    lockstep.answer(0)
    lockstep.answer(2)
    assert lockstep.published == [0, 1]
    assert lockstep.owner.barrier.ignored == 6
    assert lockstep.owner.barrier.late == 3


def test_lockstep_sends_an_unanswered_tick_again_unchanged(lockstep):
    lockstep.owner.start()
    lockstep.answer(0, topics=(ENGINE,))
    lockstep.now = 0.09
    lockstep.owner.watch()
    assert lockstep.published == [0]
    lockstep.now = 0.11
    lockstep.owner.watch()
    assert lockstep.published == [0, 0]
    assert lockstep.owner.resends == 1


def test_lockstep_names_the_silent_topics_and_the_stamp(lockstep):
    lockstep.owner.start()
    lockstep.answer(0)
    lockstep.answer(1, topics=(ENGINE,))
    lockstep.now = 1.01
    lockstep.owner.watch()
    (end,) = lockstep.ends
    assert isinstance(end, DdctError)
    assert str(end).startswith('no load/torque and no clutch/torque for stamp 1010000000 ns')


def test_the_recorder_is_part_of_the_barrier_where_required():
    harness = Harness(LockstepOwner, require_recorder=True)
    harness.owner.start()
    harness.answer(0)
    assert harness.published == [0]
    harness.answer(0, topics=(RECORDER_TOPIC,))
    assert harness.published == [0, 1]


def test_realtime_waits_for_everybody_at_t0_then_steps_on_the_grid(realtime):
    realtime.owner.tick()
    assert realtime.published == [0]
    realtime.now = 0.0101
    realtime.owner.tick()
    assert realtime.published == [0, 1]
    assert realtime.owner.missed_steps == 0


def test_realtime_holds_the_last_torques_and_counts_the_miss(realtime):
    realtime.now = 0.0101
    realtime.owner.tick()
    realtime.answer(1, topics=(LOAD,))
    realtime.now = 0.0201
    realtime.owner.tick()
    assert realtime.driveline.steps[1] == (1.0, 2.0, [POINTS[-1]] * 11)
    assert realtime.owner.missed_steps == 1
    assert realtime.owner.missed_replies == {ENGINE: 1, LOAD: 0, CLUTCH: 1}


def test_realtime_catches_up_after_a_late_timer(realtime):
    realtime.now = 0.0251
    realtime.owner.tick()
    assert realtime.published == [0, 1, 2]
    assert realtime.owner.worst_lateness_s == pytest.approx(0.0151)


def test_realtime_does_not_wait_for_the_recorder_after_t0():
    harness = Harness(RealtimeOwner, steps=1, require_recorder=True)
    harness.owner.start()
    harness.answer(0)
    harness.now = 0.5
    harness.owner.tick()
    assert harness.published == [0]
    harness.answer(0, topics=(RECORDER_TOPIC,))
    harness.now = 0.6
    harness.owner.tick()
    harness.answer(1)
    assert harness.ends == [None]


def test_realtime_gives_up_on_a_topic_that_stays_silent():
    harness = Harness(RealtimeOwner, steps=1000)
    harness.owner.start()
    harness.answer(0)
    for step in range(1, 120):
        harness.now = 0.01 * step + 0.0001
        harness.owner.tick()
        harness.answer(step, topics=(ENGINE, LOAD))
        if harness.ends:
            break
    assert str(harness.ends[0]).startswith('no clutch/torque since stamp 1000000000 ns')
