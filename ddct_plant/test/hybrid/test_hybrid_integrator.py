# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The hybrid integrator is exact, loses no energy and no event, and decides ties."""

from itertools import pairwise, product

import numpy as np
import pytest
import scipy
from modes import mode_at
from refusals import refused
from samples import sampled

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator

pytestmark = pytest.mark.slow

PIECE_S, PIECES = 0.001, 10


def rotors(
    inertias: np.ndarray, stiffness: np.ndarray, slips: np.ndarray, driven: np.ndarray
) -> FrictionSystem:
    """Return a system with states [speeds, angles] of inertias, springs and friction elements."""
    size = len(inertias)
    over = np.diag(1.0 / inertias)
    a = np.block([[np.zeros((size, size)), -over @ stiffness], [np.eye(size), 0.0 * over]])
    none = np.zeros((size, len(slips)))
    h = np.hstack([slips, none.T])
    return FrictionSystem(
        a, np.vstack([over @ driven, 0.0 * driven]), np.vstack([-over @ slips.T, none]), h
    )


def block(a: float = 0.0) -> FrictionSystem:
    """Return one inertia of 1 on the ground: dw/dt = a w + u - f."""
    return FrictionSystem(np.array([[a]]), np.eye(1), -np.eye(1), np.eye(1))


class RandomRun:
    """A random chain of inertias and springs with N friction elements, in random motion."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)
        self.elements = 1 + seed % 3
        size = self.elements + 1
        self.inertias = self.random.uniform(0.05, 2.0, size)
        springs = self.random.uniform(0.0, 500.0, size - 1)
        self.stiffness = np.diag(self.random.uniform(0.0, 300.0, size))
        for i, spring in enumerate(springs):
            self.stiffness[i : i + 2, i : i + 2] += spring * np.array([[1, -1], [-1, 1]])
        slips = np.eye(size)[: self.elements] - np.eye(size, k=1)[: self.elements]
        slips[-1] = np.eye(size)[-1]  # the last element acts against the ground
        self.system = rotors(self.inertias, self.stiffness, slips, np.eye(size)[:, :1])
        self.start = np.concatenate([self.random.uniform(-2.0, 2.0, size), np.zeros(size)])
        self.ratio = self.random.choice([1.0, 1.2])
        self.intervals = [self._interval() for _ in range(60)]

    def _interval(self) -> tuple[float, np.ndarray, np.ndarray]:
        torque = self.random.uniform(-60.0, 60.0)
        kinetic = np.maximum(self.random.uniform(-10.0, 40.0, (self.elements, PIECES + 1)), 0.0)
        return torque, kinetic, self.ratio * kinetic

    def energy(self, state: np.ndarray) -> float:
        speeds, angles = np.split(np.array(state), 2)
        return float(self.inertias @ speeds**2 + angles @ self.stiffness @ angles) / 2.0


@pytest.mark.parametrize('seed', range(12))
def test_work_done_is_kinetic_and_elastic_energy_and_friction_work(seed):
    run = RandomRun(seed)
    integrator = HybridIntegrator(run.system, PIECE_S, PIECES, held=[0])
    state, signs = run.start, mode_at(run.system, run.start)
    size = len(run.inertias)
    work_in = friction = turnover = 0.0
    kinds = set()
    for torque, kinetic, static in run.intervals:
        done = integrator.advance(state, signs, [torque], kinetic.ravel(), static.ravel())
        work = torque * (done.state[size] - state[size])
        work_in, turnover = work_in + work, turnover + abs(work)
        friction += sum(done.work)
        assert min(done.work) >= 0.0
        kinds |= {event.kind for event in done.events}
        state, signs = np.array(done.state), done.signs
    gained = run.energy(state) - run.energy(run.start)
    assert kinds >= {'lock', 'release'}
    assert friction > 0.01
    assert work_in - gained - friction == pytest.approx(0.0, abs=1e-9 * (turnover + friction))


class Cut:
    """A motion in intervals of `pieces` pieces that are `cuts` times as short."""

    def __init__(self, run: RandomRun, cuts: int, pieces: int) -> None:
        self.pieces, self.piece_s = pieces, PIECE_S / cuts
        self.integrator = HybridIntegrator(run.system, self.piece_s, pieces, held=[0])
        self.state, self.signs = run.start, mode_at(run.system, run.start)
        self.nodes = np.linspace(0.0, PIECES, cuts * PIECES + 1)

    def advance(
        self, torque: float, *capacities: np.ndarray
    ) -> tuple[list[np.ndarray], np.ndarray, list[tuple[float, int, str]]]:
        """Return the states at the ends of the short intervals, work and events."""
        kinetic, static = (
            np.array([np.interp(self.nodes, range(PIECES + 1), c) for c in each])
            for each in capacities
        )
        ends, events, work = [], [], np.zeros(len(kinetic))
        for first in range(0, len(self.nodes) - 1, self.pieces):
            now = slice(first, first + self.pieces + 1)
            done = self.integrator.advance(
                self.state,
                self.signs,
                [torque],
                kinetic[:, now].ravel(),
                static[:, now].ravel(),
            )
            self.state, self.signs = np.array(done.state), done.signs
            ends.append(self.state)
            work += done.work
            start_s = first * self.piece_s
            events += [(start_s + e.time_s, e.element, e.kind) for e in done.events]
        return ends, work, events


@pytest.mark.parametrize(('seed', 'cuts'), sampled([(0, 2), (1, 5), (2, 2), (4, 5)], every=2))
def test_the_trajectory_is_the_same_when_the_pieces_are_cut(seed, cuts):
    run = RandomRun(seed)
    whole, by_piece = Cut(run, 1, PIECES), Cut(run, 1, 1)
    others = [by_piece, Cut(run, cuts, PIECES), Cut(run, cuts, 1)]
    for interval in run.intervals:
        (end,), work, events = whole.advance(*interval)
        found = [other.advance(*interval) for other in others]
        np.testing.assert_allclose(found[2][0][cuts - 1 :: cuts], found[0][0], rtol=0.0, atol=1e-9)
        for other, (ends, other_work, other_events) in zip(others, found, strict=True):
            assert other.signs == whole.signs
            np.testing.assert_allclose(ends[-1], end, rtol=0.0, atol=1e-9)
            np.testing.assert_allclose(other_work, work, rtol=0.0, atol=1e-9)
            assert [e[1:] for e in other_events] == [e[1:] for e in events]
            expected = [e[0] for e in events]
            assert [e[0] for e in other_events] == pytest.approx(expected, abs=1e-9)


def held_torque(system: FrictionSystem, x: np.ndarray, torque: float) -> float:
    """Return what keeps the one element at rest, by the acceleration that it must cancel."""
    free = system.h[0] @ (system.a @ x + system.b[:, 0] * torque)
    return float(-free / (system.h[0] @ system.g[:, 0]))


@pytest.mark.parametrize('seed', [0, 3, 6, 9])
def test_a_random_system_moves_as_scipy_integrates_it(seed):
    """Stretch by stretch between events, and in each the mode is the one that friction allows."""
    run = RandomRun(seed)
    system, count = run.system, 0
    integrator = HybridIntegrator(system, PIECE_S, PIECES, held=[0, 1])
    state, signs = run.start, mode_at(run.system, run.start)
    for torque, nodes, _ in run.intervals:
        kinetic = 1.0 + nodes[0, 0]
        static = 1.2 * kinetic
        done = integrator.advance(state, signs, [torque], [kinetic], [static])
        sign, time_s, expected = signs[0], 0.0, state
        for event in [*done.events, None]:
            end_s = PIECE_S * PIECES if event is None else event.time_s
            if end_s > time_s:

                def derivative(_: float, x: np.ndarray, sign=sign, torque=torque, c=kinetic):
                    friction = sign * c if sign else held_torque(system, x, torque)
                    return system.a @ x + system.b[:, 0] * torque + system.g[:, 0] * friction

                solution = scipy.integrate.solve_ivp(
                    derivative, (time_s, end_s), expected, 'DOP853', rtol=1e-12, atol=1e-13
                )
                expected = solution.y[:, -1]
                for x in solution.y.T:
                    if sign:
                        assert sign * (system.h[0] @ x) >= -1e-10
                    else:
                        assert abs(held_torque(system, x, torque)) <= static * (1.0 + 1e-9)
            time_s = end_s
            if event is not None:
                count += 1
                held = held_torque(system, expected, torque)
                if event.kind == 'lock':
                    assert system.h[0] @ expected == pytest.approx(0.0, abs=1e-10)
                    assert abs(held) <= static * (1.0 + 1e-9)
                else:
                    assert abs(held) >= (static if sign == 0 else kinetic) * (1.0 - 1e-9)
                sign = 0 if event.kind == 'lock' else int(np.sign(held))
        assert (sign,) == done.signs
        np.testing.assert_allclose(done.state, expected, rtol=0.0, atol=1e-9)
        state, signs = np.array(done.state), done.signs
    assert count >= 3


@pytest.mark.parametrize(('depth', 'events'), [(1e-9, 2), (-1e-9, 0)])
def test_a_slip_that_grazes_zero_between_two_nodes_is_found(depth, events):
    """The slip is s_0 - U t + U t^2 / h, least at h/2, where it is -depth."""
    strength = 8.0
    slip = strength * PIECE_S / 4.0 - depth
    integrator = HybridIntegrator(block(), PIECE_S, 1)
    done = integrator.advance([slip], (1,), [-strength, strength], [0.0, 0.0], [0.0, 0.0])
    assert [e.kind for e in done.events] == ['reverse'] * events
    if events:
        half = np.sqrt(depth * PIECE_S / strength)
        expected = [PIECE_S / 2.0 - half, PIECE_S / 2.0 + half]
        assert [e.time_s for e in done.events] == pytest.approx(expected, abs=1e-12)
    assert done.state == pytest.approx([slip], abs=1e-15)


@pytest.mark.parametrize(
    ('torque', 'capacity', 'depth'),
    [
        (12.154104420274566, 0.0013580634007392964, 1.880001818530598e-11),
        (117.19716601036552, 0.018646299125808067, 3.843173055044242e-10),
    ],
)
def test_a_weak_element_that_sticks_for_an_instant_is_released_once(torque, capacity, depth):
    """The net torque grows within a piece to far more than the capacity, as in the graze above."""
    start = torque * PIECE_S / 4.0 - depth
    done = HybridIntegrator(block(), PIECE_S, 1).advance(
        [start], (1,), [capacity - torque, capacity + torque], [capacity] * 2, [capacity] * 2
    )
    assert [e.kind for e in done.events] == ['lock', 'release']
    assert done.state == pytest.approx([torque * PIECE_S / 4.0], abs=1e-14)


@pytest.mark.parametrize('excess', [1e-9, -1e-9])
def test_a_margin_that_is_short_between_two_nodes_releases(excess):
    """A torque sin(w t) peaks between the nodes; the capacity is the same at rest and slipping."""
    rate = np.pi / PIECE_S
    a = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, rate], [0.0, -rate, 0.0]])
    h = np.array([[1.0, 0.0, 0.0]])
    system = FrictionSystem(a, np.zeros((3, 0)), -h.T, h)
    capacity = 1.0 - excess
    integrator = HybridIntegrator(system, PIECE_S / 3.0, 3, held=[0])
    done = integrator.advance(np.array([0.0, 0.0, 1.0]), (0,), [], [capacity], [capacity])
    assert [e.kind for e in done.events] == (['release', 'lock'] if excess > 0.0 else [])
    if excess > 0.0:
        half = np.sqrt(2.0 * excess) / rate  # of the time for which the torque is too large
        expected = [PIECE_S / 2.0 - half, PIECE_S / 2.0 + 2.0 * half]
        assert [e.time_s for e in done.events] == pytest.approx(expected, abs=1e-5 * half)


@pytest.mark.parametrize('ratio', [1.0, 1.0 + 1e-12, 1.3])
def test_a_release_is_one_event_at_any_ratio_of_static_to_kinetic_capacity(ratio):
    """With ratio 1 the slip begins without acceleration: the tie is decided by its derivative."""
    integrator = HybridIntegrator(block(), PIECE_S, PIECES)
    torque = np.linspace(0.0, 10.0, PIECES + 1)
    capacity = np.full(PIECES + 1, 4.05)
    done = integrator.advance(np.zeros(1), (0,), torque, capacity, ratio * capacity)
    assert [(e.element, e.kind) for e in done.events] == [(0, 'release')]
    start_s = done.events[0].time_s
    assert start_s == pytest.approx(ratio * 4.05e-3, abs=1e-15)
    left_s = PIECE_S * PIECES - start_s
    gained = (ratio - 1.0) * 4.05 * left_s + 1000.0 * left_s**2 / 2.0
    assert done.state == pytest.approx([gained], rel=1e-12)


def symmetric_star(arms: int) -> FrictionSystem:
    """Return a driven hub with equal inertias around it, each on a friction element."""
    slips = np.hstack([np.ones((arms, 1)), -np.eye(arms)])
    size = arms + 1
    return rotors(np.ones(size), np.zeros((size, size)), slips, np.eye(size)[:, :1])


@pytest.mark.parametrize('arms', [2, 3])
@pytest.mark.parametrize('ratio', [1.0, 1.25])
def test_elements_that_release_together_do_so_in_one_instant(arms, ratio):
    """Each arm of inertia 1 takes u / (arms + 1) while it sticks."""
    system = symmetric_star(arms)
    integrator = HybridIntegrator(system, PIECE_S, PIECES)
    torque = np.linspace(0.0, 100.0, PIECES + 1)
    capacity = np.full(PIECES + 1, 8.0)
    state = np.zeros(2 * arms + 2)
    kinetic = np.tile(capacity, arms)
    done = integrator.advance(state, (0,) * arms, torque, kinetic, ratio * kinetic)
    assert sorted((e.element, e.kind) for e in done.events) == [
        (i, 'release') for i in range(arms)
    ]
    expected = ratio * 8.0 * (arms + 1) / 1e4
    assert [e.time_s for e in done.events] == pytest.approx([expected] * arms, abs=1e-15)
    hub, *others = done.state[: arms + 1]
    assert done.signs == (1,) * arms
    assert others == pytest.approx([others[0]] * arms, rel=1e-13)


@pytest.mark.parametrize('arms', [2, 3])
def test_elements_that_lock_together_do_so_in_one_instant(arms):
    integrator = HybridIntegrator(symmetric_star(arms), PIECE_S, PIECES, held=range(arms + 1))
    state = np.zeros(2 * arms + 2)
    state[0] = 0.1
    signs = mode_at(integrator.system, state)
    assert signs == (1,) * arms
    done = integrator.advance(state, signs, [0.0], [8.0] * arms, [8.0] * arms)
    assert done.signs == (0,) * arms
    assert {e.kind for e in done.events} == {'lock'}
    assert [e.time_s for e in done.events] == pytest.approx([0.1 / (8.0 * (arms + 1))] * arms)


def test_capacity_that_equals_the_held_torque_lets_it_stick_without_events():
    """A tie in every derivative: neither chatter nor drift, for a second."""
    integrator = HybridIntegrator(symmetric_star(2), PIECE_S, PIECES, held=range(3))
    state, signs = np.zeros(6), mode_at(integrator.system, np.zeros(6))
    for _ in range(100):
        done = integrator.advance(state, signs, [0.3], [0.1, 0.1], [0.1, 0.1])
        assert done.events == []
        state, signs = np.array(done.state), done.signs
    assert state[:3] == pytest.approx([0.1] * 3, rel=1e-12)


def test_two_events_in_one_piece():
    """A block at -5e-4 is pushed through zero: it locks, and slips the other way."""
    integrator = HybridIntegrator(block(), PIECE_S, 1)
    done = integrator.advance([-0.0005], (-1,), [0.0, 12.0], [2.0, 2.0], [3.0, 3.0])
    assert [e.kind for e in done.events] == ['lock', 'release']
    # w(t) = -0.0005 + 2 t + 6000 t^2, then at rest until u = 3 at a quarter of the piece.
    lock_s = (-2.0 + np.sqrt(4.0 + 4.0 * 6000.0 * 0.0005)) / 12000.0
    assert [e.time_s for e in done.events] == pytest.approx([lock_s, 0.00025], abs=1e-15)
    # Before the lock the kinetic capacity adds to u; after the release it is 1 below the static.
    slopes = [2.0 + 12000.0 * lock_s, 3.0 - 2.0]
    assert [e.slip_acceleration for e in done.events] == pytest.approx(slopes, rel=1e-12)
    moved_s = 0.00075
    expected = (3.0 - 2.0) * moved_s + 12000.0 * moved_s**2 / 2.0
    assert done.state == pytest.approx([expected], rel=1e-12)
    moved = (3.0 - 2.0) * moved_s**2 / 2.0 + 12000.0 * moved_s**3 / 6.0
    before = 0.0005 * lock_s - lock_s**2 - 2000.0 * lock_s**3
    assert done.work == pytest.approx([2.0 * (moved + before)], rel=1e-10)


def test_an_open_element_reverses_without_locking():
    integrator = HybridIntegrator(block(), PIECE_S, PIECES, held=[0, 1])
    done = integrator.advance(np.array([0.005]), (1,), [-1.0], [0.0], [0.0])
    (event,) = done.events
    assert event.kind == 'reverse'
    assert event.time_s == pytest.approx(0.005)
    assert event.slip_acceleration == pytest.approx(-1.0)
    assert done.work == [0.0]


@pytest.mark.parametrize('sign', [1, -1])
@pytest.mark.parametrize(('static', 'kind'), [(3.0, 'lock'), (2.0, 'reverse')])
def test_static_capacity_above_the_push_locks_from_either_side(sign, static, kind):
    """A push of 2.5 through zero is held by a static capacity of 3, and not by one of 2."""
    integrator = HybridIntegrator(block(), PIECE_S, PIECES, held=[0, 1])
    done = integrator.advance([sign * 0.009], (sign,), [-sign * 2.5], [2.0], [static])
    (event,) = done.events
    assert event.kind == kind
    assert event.time_s == pytest.approx(0.002, rel=1e-12)
    assert event.slip_acceleration == pytest.approx(-sign * 4.5, rel=1e-12)
    beyond = 0.5 * 0.008 if kind == 'reverse' else 0.0
    assert done.state == pytest.approx([-sign * beyond], rel=1e-12, abs=0.0)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_release_with_equal_capacities_starts_without_acceleration(sign):
    integrator = HybridIntegrator(block(), PIECE_S, PIECES, held=[1])
    push = (sign * np.linspace(0.0, 4.0, PIECES + 1)).tolist()
    (event,) = integrator.advance([0.0], (0,), push, [2.0], [2.0]).events
    assert (event.kind, event.slip_acceleration) == ('release', 0.0)
    assert np.copysign(1.0, event.slip_acceleration) == 1.0


@pytest.mark.parametrize(
    ('system', 'message'),
    [
        ({'g': [[1.0], [0.0]]}, 'h g of element 0 is 1, it must be negative'),
        ({'g': [[0.0], [-1.0]]}, 'h g of element 0 is 0, it must be negative'),
        ({'h': [[1.0, 0.0]] * 2, 'g': [[-1.0, -1.0], [0.0, 0.0]]}, 'is singular'),
        ({'h': [[1.0]]}, r'h is \(1, 1\), it must be \(1, 2\)'),
        ({'a': [[np.nan, 0.0], [0.0, 0.0]]}, 'a must be a matrix of finite numbers'),
    ],
)
def test_an_impossible_system_is_refused(system, message):
    given = {'a': np.zeros((2, 2)), 'b': np.zeros((2, 0)), 'g': [[-1.0], [0.0]], 'h': [[1.0, 0.0]]}
    with pytest.raises(ParameterError, match=message):
        FrictionSystem(**{**given, **system})


@pytest.mark.parametrize(
    ('kinetic', 'static', 'message'),
    [
        ([-1.0], [1.0], 'its capacity -1.0 must not be negative'),
        ([2.0], [1.0], 'static capacity 1.0 is below the kinetic one 2.0'),
        ([1.0], [1.0] * 11, '1 kinetic and 11 static capacities do not fit the interval'),
    ],
)
def test_impossible_capacities_are_refused(kinetic, static, message):
    integrator = HybridIntegrator(block(), PIECE_S, PIECES, held=[1])
    with pytest.raises(ParameterError, match=message):
        integrator.advance([1.0], (1,), [0.0] * 11, kinetic, static)
    nodes = HybridIntegrator(block(), PIECE_S, PIECES, held=[0])
    with refused(ParameterError, 'friction element 0'):
        nodes.advance([1.0], (1,), [0.0], [1.0] * 11, [1.0] * 10 + [0.9])
    with pytest.raises(ParameterError, match='do not fit the interval'):
        nodes.advance([1.0], (1,), [0.0], [1.0] * 5, [1.0] * 5)
    with pytest.raises(ParameterError, match='do not fit the interval'):
        nodes.advance([1.0], (1,), [0.0] * 3, [1.0] * 11, [1.0] * 11)


def test_a_piece_must_be_longer_than_zero_and_short_enough_for_the_rates():
    with refused(ParameterError, key='piece_s'):
        HybridIntegrator(block(), 0.0, PIECES)
    with pytest.raises(ParameterError, match='take pieces of at most 0.0004 s'):
        HybridIntegrator(block(a=-1e4), PIECE_S, PIECES)


def test_a_mode_is_prepared_when_a_motion_first_has_it():
    integrator = HybridIntegrator(block(), PIECE_S, PIECES, held=[0, 1])
    assert not integrator.flows
    done = integrator.advance([1.0], (1,), [0.0], [1.0], [1.0])
    assert done.signs == (1,)
    assert list(integrator.flows) == list(integrator.maps) == [(1,)]


@pytest.mark.parametrize('count', sampled([3, 100, 1, 2], every=2))
def test_a_mode_prepared_for_many_systems_at_once_is_to_the_last_bit_that_of_each(count):
    runs = [RandomRun(3 * seed + 1) for seed in range(count)]
    alone, together = (
        [HybridIntegrator(run.system, PIECE_S, PIECES, held=[0]) for run in runs] for _ in range(2)
    )
    extents = set()
    for signs in product((-1, 0, 1), repeat=2):
        HybridIntegrator.prepare([*together, together[0]], signs)
        for run, one, other in zip(runs, alone, together, strict=True):
            assert signs in other.maps
            ours, theirs = other.flows[signs], one.flows[signs]
            extents.add((ours.degree, ours.steps))
            for name in ('projection', 'force', 'series', 'sizes', 'end'):
                assert getattr(ours, name).tobytes() == getattr(theirs, name).tobytes(), name
            torque, kinetic, _ = run.intervals[0]
            values = np.concatenate([run.start, [torque], kinetic.ravel()])
            for found, expected in zip(
                other.maps[signs].by_piece(values), one.maps[signs].by_piece(values), strict=True
            ):
                assert np.asarray(found).tobytes() == np.asarray(expected).tobytes()
            whole = (each.maps[signs].whole(values, kinetic.ravel()) for each in (one, other))
            assert next(whole) == next(whole)
    assert len(extents) > 1 or count == 1


def test_values_that_are_not_finite_end_in_an_error():
    integrator = HybridIntegrator(block(), PIECE_S, PIECES, held=[0, 1])
    with pytest.raises(DdctError, match='not finite'):
        integrator.advance(np.array([1.0]), (1,), [np.nan], [1.0], [1.0])


def test_no_slip_is_too_small_to_be_one():
    """A slip of a femtoradian per second is a slip, and friction ends it when it should."""
    integrator = HybridIntegrator(block(), PIECE_S, PIECES, held=[0, 1])
    done = integrator.advance(np.array([1e-15]), (1,), [0.0], [1e-12], [1e-12])
    (event,) = done.events
    assert event.kind == 'lock'
    assert event.time_s == pytest.approx(1e-3, rel=1e-12)


def test_events_come_in_the_order_of_time():
    run = RandomRun(2)
    integrator = HybridIntegrator(run.system, PIECE_S, PIECES, held=[0])
    state, signs = run.start, mode_at(run.system, run.start)
    for torque, kinetic, static in run.intervals:
        done = integrator.advance(state, signs, [torque], kinetic.ravel(), static.ravel())
        assert all(one.time_s <= two.time_s for one, two in pairwise(done.events))
        state, signs = np.array(done.state), done.signs
