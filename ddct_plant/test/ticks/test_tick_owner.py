# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline steps only on whole ticks, sends again, and gives up with a reason."""

import pytest

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.ticks.realtime_owner import RECORDER_PATIENCE_S, RealtimeOwner
from ddct_plant.ticks.tick_owner import PROOF, TickOwner, TickPlan

TORQUES = ('engine/torque', 'load/torque', 'clutch/torque')
ENGINE, LOAD, CLUTCH = TORQUES
OFF_GOING = 'off_going/clutch/torque'
RECORDER = 'recorder/ack'
HOLDING = 'load/holding_torque'
STICK_SLIP = (*TORQUES, HOLDING)
"""Topics of a run with the stick-slip clutch; the holding torque of the wheels is added."""
POINTS = [float(i) for i in range(11)]


class FakeDriveline:
    def __init__(self):
        self.steps = []

    def step(self, engine, load, *clutch_and_holding):
        clutch = [list(row) if isinstance(row, list) else row for row in clutch_and_holding]
        self.steps.append((engine, load, *clutch))


class Harness:
    """An owner with a hand-driven clock; records what it publishes and how it ends."""

    def __init__(
        self,
        owner_type,
        steps=3,
        require_recorder=False,
        torques=TORQUES,
        clutch=(POINTS,),
        clutches=(CLUTCH,),
        over=lambda: False,
    ):
        self.now = 0.0
        self.published: list[int] = []
        self.ends: list[DdctError | None] = []
        self.clutch = clutch
        self.driveline = FakeDriveline()
        self.owner = owner_type(
            self.driveline.step,
            TickPlan(torques, clutches, RECORDER if require_recorder else '', steps, 1.0),
            self.published.append,
            self.ends.append,
            clock=lambda: self.now,
            over=over,
        )

    def answer(self, step, engine=1.0, topics=(ENGINE, LOAD, CLUTCH)):
        replies = {
            ENGINE: engine,
            LOAD: 2.0,
            CLUTCH: self.clutch,
            HOLDING: 60.0,
            OFF_GOING: self.clutch,
            RECORDER: None,
        }
        for topic in topics:
            self.owner.offer(topic, stamp_of_step(step), replies[topic])


@pytest.fixture
def lockstep():
    return Harness(TickOwner)


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


@pytest.mark.parametrize('owner', [TickOwner, RealtimeOwner])
def test_a_run_that_begins_on_nodes_which_have_run_already_names_them(owner):
    harness = Harness(owner)
    harness.owner.start()
    harness.answer(3, topics=(ENGINE, CLUTCH))
    harness.answer(0, topics=(ENGINE,))
    harness.now = 1.01
    harness.owner.watch()
    assert [str(end) for end in harness.ends] == [
        'no load/torque and no clutch/torque for stamp 1000000000 ns (step 0) within 1 s: the '
        'nodes which publish clutch/torque have already run with another driveline, so stop all '
        'nodes and start the graph again'
    ]


def test_nodes_that_have_run_are_not_waited_for_to_the_end(lockstep):
    lockstep.owner.start()
    for _ in range(PROOF):
        lockstep.owner.watch()
        assert not lockstep.ends
        lockstep.answer(3)
    lockstep.owner.watch()
    (end,) = lockstep.ends
    assert 'within 0 s: the nodes which publish engine/torque and load/torque and' in str(end)


def test_a_false_stamp_before_the_first_step_explains_no_silence_after_it(lockstep):
    lockstep.owner.start()
    lockstep.answer(3, topics=(ENGINE,))
    lockstep.answer(0)
    lockstep.now = 1.01
    lockstep.owner.watch()
    (end,) = lockstep.ends
    assert str(end).endswith(
        'check that /engine, /load, /clutch and what they wait for run, and read their logs: a '
        'node that refused a message says why'
    )


def test_lockstep_never_steps_on_a_reply_to_another_tick(lockstep):
    lockstep.owner.start()
    lockstep.answer(0)
    lockstep.answer(0)
    lockstep.answer(2)
    assert lockstep.published == [0, 1]
    assert lockstep.owner.late == 3


def test_replies_to_the_tick_of_now_are_never_late_however_often_they_come(lockstep):
    lockstep.owner.start()
    for _ in range(3):
        lockstep.answer(0, topics=(ENGINE,))
    assert lockstep.owner.late == 0
    lockstep.answer(0, topics=(LOAD, CLUTCH))
    lockstep.answer(0, topics=(LOAD,))
    assert lockstep.owner.step == 1
    assert lockstep.owner.late == 1, 'the one of t_0, after its step'


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


def test_lockstep_names_the_missing_topics_and_the_stamp(lockstep):
    lockstep.owner.start()
    lockstep.answer(0)
    lockstep.answer(1, topics=(ENGINE,))
    lockstep.now = 1.01
    lockstep.owner.watch()
    (end,) = lockstep.ends
    assert isinstance(end, DdctError)
    assert str(end).startswith('no load/torque and no clutch/torque for stamp 1010000000 ns')


def test_the_recorder_is_part_of_the_barrier_where_required():
    harness = Harness(TickOwner, require_recorder=True)
    harness.owner.start()
    harness.answer(0)
    assert harness.published == [0]
    harness.answer(0, topics=(RECORDER,))
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
    assert realtime.owner.durations.lateness == pytest.approx([0.0151, 0.0051])


def test_realtime_measures_lateness_and_the_latency_of_late_replies_too(realtime):
    durations = realtime.owner.durations
    assert durations.lateness == durations.latency == [], 'the start barrier does not count'
    for now in (0.0102, 0.0205):
        realtime.now = now
        realtime.owner.tick()
    realtime.now = 0.0225
    realtime.answer(1)
    realtime.answer(2)
    assert durations.lateness == pytest.approx([0.0002, 0.0005])
    assert durations.latency == pytest.approx([0.0123, 0.002])
    assert realtime.owner.missed_steps == 1


@pytest.fixture
def recorded():
    """Return a harness at t_2, the last tick, of a run with a recorder that received t_0 only."""
    harness = Harness(RealtimeOwner, steps=2, require_recorder=True)
    harness.owner.start()
    harness.answer(0)
    harness.now = 0.5
    harness.owner.tick()
    assert harness.published == [0], 't_0 waits for the recorder'
    harness.answer(0, topics=(RECORDER,))
    harness.now = 0.511
    harness.owner.tick()
    harness.answer(1)
    harness.now = 0.521
    harness.owner.tick()
    assert harness.published == [0, 1, 2], 't_1 does not'
    harness.answer(2)
    assert harness.ends == []
    return harness


def test_realtime_ends_when_the_recorder_has_the_last_tick(recorded):
    recorded.answer(2, topics=(RECORDER,))
    assert recorded.ends == [None]


def test_realtime_sends_the_last_tick_again_for_the_recorder_and_ends_well_without_it(recorded):
    recorded.now += 0.2
    recorded.owner.watch()
    assert recorded.published == [0, 1, 2, 2]
    recorded.now += RECORDER_PATIENCE_S
    recorded.owner.watch()
    assert recorded.ends == [None]


def test_realtime_gives_up_on_a_topic_that_stays_missing():
    harness = Harness(RealtimeOwner, steps=1000)
    harness.owner.start()
    harness.answer(0)
    for step in range(1, 120):
        harness.now = 0.01 * step + 0.0001
        harness.owner.tick()
        harness.answer(step, topics=(ENGINE, LOAD))
        if harness.ends:
            break
    assert str(harness.ends[0]) == (
        'no clutch/torque since stamp 1000000000 ns, 1.01 s ago: check that the node which '
        'publishes it is running'
    )


class Run(Harness):
    """A long real-time run whose replies a test gives or leaves out, step by step."""

    def __init__(self, steps=1000, topics=(ENGINE, LOAD, CLUTCH), **options):
        super().__init__(RealtimeOwner, steps=steps, **options)
        self.owner.start()
        self.answer(0, topics=topics)

    def go_to(self, last, topics=(ENGINE, LOAD, CLUTCH)):
        """Step until t_last is out; `topics` answer each tick on the way, and it."""
        for step in range(self.owner.step + 1, last + 1):
            self.now = 0.01 * step + 0.0001
            self.owner.tick()
            self.answer(step, topics=topics)


def test_a_reply_ends_a_silence():
    run = Run()
    for silent_to in (91, 182, 273):
        run.go_to(silent_to - 1, topics=(ENGINE, CLUTCH))
        run.go_to(silent_to)
    assert run.owner.missed_replies[LOAD] == 3 * 90
    assert run.ends == []


def test_a_clutch_torque_that_stays_away_is_held_then_runs_to_zero_at_the_stated_rate():
    run = Run()
    run.go_to(20)
    run.go_to(60, topics=(ENGINE, LOAD))
    torques = [clutch for _, _, clutch in run.driveline.steps]
    assert torques[20] == POINTS
    assert torques[21:31] == [[10.0] * 11] * 10
    # 10 N m at 1000 N m/s: the last period of the ramp is the first one.
    assert torques[31] == pytest.approx([10.0 - i for i in range(11)])
    assert torques[32:] == [[0.0] * 11] * len(torques[32:])
    assert run.owner.safe_clutches == [CLUTCH]


def test_a_clutch_torque_that_comes_back_after_the_safe_state_counts_no_more():
    run = Run()
    run.go_to(20)
    run.go_to(32, topics=(ENGINE, LOAD))
    assert run.owner.safe_clutches
    run.go_to(60)
    assert run.owner.safe_clutches
    assert run.driveline.steps[-1][2] == [0.0] * 11


def test_a_clutch_torque_that_comes_back_in_time_is_taken():
    run = Run()
    run.go_to(20)
    run.go_to(30, topics=(ENGINE, LOAD))
    run.go_to(32)
    assert not run.owner.safe_clutches
    assert run.driveline.steps[-1][2] == POINTS


def test_the_last_tick_waits_for_no_clutch_torque_in_the_safe_state():
    run = Run(steps=40)
    run.go_to(20)
    run.go_to(40, topics=(ENGINE, LOAD))
    assert run.ends == [None]


def test_a_stick_slip_run_waits_for_the_holding_torque_and_steps_on_both_capacities():
    clutch = (POINTS, [2.0 * each for each in POINTS])
    harness = Harness(TickOwner, torques=STICK_SLIP, clutch=clutch)
    harness.owner.start()
    harness.answer(0)
    assert harness.owner.missing() == [HOLDING]
    harness.answer(0, topics=(HOLDING,))
    assert harness.driveline.steps == [(1.0, 2.0, *clutch, 60.0)]


def capacities_of(run):
    """Return the kinetic and the static capacities of each step."""
    return zip(
        *[(kinetic, static) for _, _, kinetic, static, _ in run.driveline.steps], strict=True
    )


def test_capacities_that_stay_away_run_to_zero_together_and_never_below():
    """The static one stays in proportion: it never falls below the kinetic one, or below zero."""
    clutch = ([23.0] * 11, [1.3 * 23.0] * 11)
    run = Run(torques=STICK_SLIP, clutch=clutch, topics=(ENGINE, LOAD, CLUTCH, HOLDING))
    run.go_to(20, topics=(ENGINE, LOAD, CLUTCH, HOLDING))
    run.go_to(60, topics=(ENGINE, LOAD, HOLDING))
    kinetic, static = capacities_of(run)
    assert kinetic[30] == [23.0] * 11
    assert [row[-1] for row in kinetic[31:35]] == pytest.approx([13.0, 3.0, 0.0, 0.0])
    assert [row[-1] for row in static[31:35]] == pytest.approx([16.9, 3.9, 0.0, 0.0])
    for low, high in zip(kinetic, static, strict=True):
        assert all(0.0 <= k <= s for k, s in zip(low, high, strict=True))


def test_a_missing_holding_torque_holds_the_last_and_is_counted():
    clutch = (POINTS, POINTS)
    run = Run(torques=STICK_SLIP, clutch=clutch, topics=(ENGINE, LOAD, CLUTCH, HOLDING))
    run.go_to(20, topics=(ENGINE, LOAD, CLUTCH))
    assert {step[-1] for step in run.driveline.steps} == {60.0}
    assert run.owner.missed_replies[HOLDING] == 19
    assert run.owner.missed_steps == 19
    assert not run.owner.safe_clutches


SHIFT = (*STICK_SLIP, OFF_GOING)
"""Topics of a gear shift, with the capacities of a second clutch."""


@pytest.mark.parametrize('missing', [[CLUTCH], [OFF_GOING], [CLUTCH, OFF_GOING]])
def test_of_two_clutches_the_one_whose_torque_stays_away_opens(missing):
    capacities = ([23.0] * 11, [23.0] * 11)
    run = Run(torques=SHIFT, clutches=(CLUTCH, OFF_GOING), clutch=capacities, topics=SHIFT)
    run.go_to(20, topics=SHIFT)
    run.go_to(60, topics=[topic for topic in SHIFT if topic not in missing])
    assert run.owner.safe_clutches == missing
    engine, load, on_coming, _, holding, off_going, _ = zip(*run.driveline.steps, strict=True)
    for topic, kinetic in ((CLUTCH, on_coming), (OFF_GOING, off_going)):
        if topic in missing:
            assert kinetic[30] == [23.0] * 11
            assert [row[-1] for row in kinetic[31:35]] == pytest.approx([13.0, 3.0, 0.0, 0.0])
        else:
            assert set(map(tuple, kinetic)) == {(23.0,) * 11}
    assert {*engine, *load, *holding} == {1.0, 2.0, 60.0}


@pytest.mark.parametrize('owner_type', [TickOwner, RealtimeOwner])
def test_the_first_state_that_is_over_is_the_last_tick_recorder_and_all(owner_type):
    harness: Harness = Harness(
        owner_type,
        steps=9,
        require_recorder=True,
        over=lambda: len(harness.driveline.steps) == 2,
    )
    harness.owner.start()
    everything = (ENGINE, LOAD, CLUTCH, RECORDER)
    harness.answer(0, topics=everything)
    for step in (1, 2):
        harness.now = 0.01 * step + 0.0001
        if owner_type is RealtimeOwner:
            harness.owner.tick()
        assert harness.ends == []
        harness.answer(step, topics=everything)
    assert harness.published == [0, 1, 2]
    assert harness.ends == [None]
