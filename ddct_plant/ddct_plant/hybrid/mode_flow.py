# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The exact flow of one mode, that is of a set of sticking and slipping elements."""

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.hybrid.friction_system import FrictionSystem, Signs
from ddct_plant.hybrid.polynomials import first_negative, integral_with

LONGEST = 4.0
"""Longest piece, in units of 1 / (the balanced norm of a)."""
ROUNDING = 2.0**-53
"""Term of a series that counts as zero, over the sum."""
CANCELLED = 2.0**-40
"""Entry of a projection that counts as zero, over its terms."""
NODE_ANGLE = 0.3
"""Angle in rad by which the fastest undamped mode turns from node to node at most."""


class HeldElements:
    """
    A system while a set S of its elements sticks, in all modes in which no other one does.

    `projection` P (n, n) takes the slips of these elements to zero; `hold` is (h_S g_S)^-1 h_S.
    Entries of both that are rounding of their terms are zero. So where sticking elements stop a
    state altogether its rates are zero, and one that holds nothing has no torque.
    """

    def __init__(self, system: FrictionSystem, stuck: tuple[bool, ...], piece_s: float) -> None:
        """Raise ParameterError where the rates are too fast for the series over a piece."""
        self.a, self.b, self.g, self.h = system.a, system.b, system.g, system.h
        self.piece_s, self.stuck = piece_s, np.array(stuck)
        rows, columns = system.h[self.stuck], system.g[:, self.stuck]
        mobility = rows @ columns
        hold = np.linalg.solve(mobility, rows)
        hold[np.abs(hold) <= CANCELLED * (np.abs(np.linalg.inv(mobility)) @ np.abs(rows))] = 0.0
        one = np.eye(len(system.a))
        projection = one - columns @ hold
        projection[np.abs(projection) <= CANCELLED * (one + np.abs(columns) @ np.abs(hold))] = 0.0
        self.projection, self.hold = projection, hold
        self.rates = projection @ system.a
        """State matrix while these elements stick, (n, n)."""
        self.balanced = balanced(self.rates * piece_s)
        """Rates over a piece in balanced units, (n, n)."""
        size = _norm(self.balanced)
        if size > LONGEST:
            raise ParameterError(
                f'friction system: it has rates of {size / piece_s:g} rad/s: take pieces of at '
                f'most {LONGEST * piece_s / size:.3g} s in place of {piece_s:g} s'
            )

    @cached_property
    def extent(self) -> tuple[int, int]:
        """Degree of the series and number of steps of a piece, see `extents`."""
        return extents([self])[0]

    @classmethod
    def stack(cls, members: Sequence['HeldElements']) -> 'HeldElements':
        """Return those of systems of one shape and extent, each matrix with a first axis of R."""
        stack = copy(members[0])
        for name in ('a', 'b', 'g', 'h', 'projection', 'hold'):
            setattr(stack, name, np.array([getattr(each, name) for each in members]))
        return stack


def extents(members: Sequence[HeldElements]) -> list[tuple[int, int]]:
    """
    Return degree of the series and number of steps of a piece, of systems of one shape.

    The degree is the order at which the terms of exp(a piece) are below rounding. The last term is
    below the rounding of 1 in balanced units. These may differ by many powers of ten, so the next
    term is below that of the sum in the units of `a` too. Guards are evaluated at the ends of the
    steps, the nodes.
    """
    # The magnitude of a damped eigenvalue is the frequency without its damping.
    eigenvalues = np.linalg.eigvals(np.array([each.rates for each in members]))
    fastest = np.abs(eigenvalues).max(axis=-1)
    steps = [max(1, ceil(members[0].piece_s * rate / NODE_ANGLE)) for rate in fastest.tolist()]
    rates = np.array([each.rates * each.piece_s for each in members])
    scaled = np.array([each.balanced for each in members])
    degrees = np.zeros(len(members), dtype=int)
    degree, term, scaled_term = 2, rates @ rates / 2.0, scaled @ scaled / 2.0
    total = np.eye(rates.shape[-1]) + rates + term
    while True:
        following = term @ rates / (degree + 1)
        small = _norm(scaled_term) <= ROUNDING
        small &= _norm(following) <= ROUNDING * _norm(total)
        degrees[small & (degrees == 0)] = degree
        if degrees.all():
            return list(zip(degrees.tolist(), steps, strict=True))
        degree += 1
        term, scaled_term = following, scaled_term @ scaled / degree
        total += term


class ModeFlow:
    """
    Series of exp(M t) in one mode, for the states and for the guards, positive while it lasts.

    y = [x, w, dw] holds the states, the inputs w = [u, c] (c the kinetic capacity of an element
    that slips, the static one of an element that sticks) and their change over one piece. With
    t from 0 to 1 over the piece dy/dt = M y is autonomous: dx = piece (P a x + P [b, g sign] w),
    w' = dw. Guards: the slip times its sign; c - f and c + f of an element that sticks.

    For a stack of R systems the matrices have a first axis of R, and each is computed as alone.
    """

    def __init__(self, held: HeldElements, signs: Signs) -> None:
        """Prepare the mode in which the elements that are not held slip with `signs`."""
        self.signs = signs
        stack, (states, inputs) = held.b.shape[:-2], held.b.shape[-2:]
        self.states, self.inputs = states, inputs + len(signs)
        self.projection, (self.degree, self.steps) = held.projection, held.extent
        driven = np.concatenate([held.b, held.g * signs], axis=-1)
        moved = np.concatenate([held.a, driven], axis=-1)
        size, width = states + 2 * self.inputs, states + self.inputs
        generator = np.zeros((*stack, size, size))
        generator[..., :states, :width] = held.piece_s * self.projection @ moved
        generator[..., states:width, width:] = np.eye(self.inputs)
        self.force = np.zeros((*stack, len(signs), width))
        """Friction torques as rows on [x, w], (N, n + w)."""
        self.force[..., states + inputs :] = np.diag(signs)
        self.force[..., held.stuck, :] = -held.hold @ moved
        guards, self.guarded = self._guards(held.h)
        self.slipping = [i for i, sign in enumerate(signs) if sign]
        """Indices of the slipping elements."""
        self.slip_guards = [self.guarded.index(i) for i in self.slipping]
        rows = np.zeros((*stack, states + len(self.guarded), size))
        rows[..., :states, :states] = self.projection
        rows[..., states:, :width] = guards
        powers = [rows]
        for order in range(1, self.degree + 1):
            powers.append(powers[-1] @ generator / order)
        self.series = np.stack(powers, axis=-3)
        self.powers = np.arange(self.degree + 1)
        """Exponents 0, 1, ..., d."""
        self._series = self.series.reshape(*stack, -1, size)
        # Instants are known to rounding of a piece, so y to that of how much it changes in one.
        within = np.eye(size) + np.abs(generator)
        self.sizes = np.abs(self.series[..., states:, :]).reshape(*stack, -1, size) @ within
        self.end = self.series[..., :states, :].sum(axis=-3)
        """State after a piece, as rows on y, (n, y)."""

    def of_system(self, place: int) -> 'ModeFlow':
        """Return the flow of one system of a stack."""
        flow = copy(self)
        for name in ('projection', 'force', 'series', '_series', 'sizes', 'end'):
            setattr(flow, name, getattr(self, name)[place])
        return flow

    def _guards(self, h: np.ndarray) -> tuple[np.ndarray, list[int]]:
        """Return the rows of the guards on [x, w], and the index of each guard's element."""
        rows: list[np.ndarray] = []
        guarded: list[int] = []
        capacities = np.eye(self.states + self.inputs)[-len(self.signs) :]
        for i, sign in enumerate(self.signs):
            force = self.force[..., i, :]
            if sign:
                slip = np.zeros_like(force)
                slip[..., : self.states] = sign * h[..., i, :]
                rows.append(slip)
            else:
                rows += [capacities[i] - force, capacities[i] + force]
            guarded += [i] * (len(rows) - len(guarded))
        return np.stack(rows, axis=-2), guarded

    def guard_checks(self) -> np.ndarray:
        """
        Return what is not negative in a piece without an event, as rows on y, (c, guards, y).

        For each step these are the guards at its start, then the tangents at its start and at its
        end, both halfway between them. The guards at the end of the piece come last. A cubic with
        such values and slopes is positive within the step too, with a margin of a quarter of the
        values. In 0.3 rad a guard differs from a cubic by 0.3^4 / 384 = 2e-5 of its oscillation.
        """
        guards = self.series[..., self.states :, :]
        nodes = np.arange(self.steps + 1)[:, None] / self.steps
        orders = np.arange(1, self.degree + 1)
        values = _combined(nodes**self.powers, guards)
        slopes = _combined(orders * nodes ** self.powers[:-1], guards[..., 1:, :, :])
        halfway = slopes / (2.0 * self.steps)
        first, last = values[..., :-1, :, :], values[..., 1:, :, :]
        steps = np.stack(
            [first, first + halfway[..., :-1, :, :], last - halfway[..., 1:, :, :]], axis=-3
        )
        flat = steps.reshape(*guards.shape[:-3], -1, *guards.shape[-2:])
        return np.concatenate([flat, values[..., -1:, :, :]], axis=-3)

    def slip_integrals(self) -> np.ndarray:
        """
        Return the integrals of |s| (1 - t) and |s| t over a piece, as rows on y.

        Their shape is (2, slipping elements, y).
        """
        orders = self.powers[:, None, None]
        slips = self.series[..., self.states :, :][..., self.slip_guards, :]
        rising = (slips / (orders + 2)).sum(axis=-3)
        return np.stack([(slips / (orders + 1)).sum(axis=-3) - rising, rising], axis=-3)

    def course(self, state: np.ndarray, forcing: np.ndarray) -> 'Course':
        """Return the motion from a state (n,) on, with the inputs [w, dw], (2 w,)."""
        y = np.concatenate((state, forcing))
        values = self._series.dot(y).reshape(self.degree + 1, -1)
        return Course(self, y, values[:, : self.states], values[:, self.states :].T)


class Course(NamedTuple):
    """Motion in one mode from an instant on, as polynomials in t; t = 1 is a piece later."""

    flow: ModeFlow
    """Flow of the mode."""
    y: np.ndarray
    """State, inputs and their change [x, w, dw] at t = 0."""
    states: np.ndarray
    """Coefficients of t^k of the states, (d+1, n)."""
    guards: np.ndarray
    """Coefficients of t^k of the guards, (guards, d+1)."""

    def at(self, part: float) -> np.ndarray:
        """Return the state (n,) at t = `part`."""
        return (part**self.flow.powers).dot(self.states)

    def slip_slope(self, element: int, part: float) -> float:
        """Return the slip's derivative by t of a slipping element at t = `part`."""
        flow = self.flow
        coefficients = self.guards[flow.guarded.index(element)].tolist()
        slope = 0.0
        for order in range(flow.degree, 0, -1):
            slope = slope * part + order * coefficients[order]
        return flow.signs[element] * slope + 0.0  # no zero with a sign

    def friction(self) -> np.ndarray:
        """Return the coefficients of t^k of the friction torques, (N, d+1)."""
        flow = self.flow
        inputs = self.y[flow.states :].reshape(2, -1)
        torques = flow.force[:, : flow.states].dot(self.states.T)
        torques[:, :2] += flow.force[:, flow.states :].dot(inputs.T)
        return torques

    def capacities(self) -> tuple[list[float], list[float]]:
        """Return the capacities at t = 0, and their change over a piece, (N,) each."""
        elements = len(self.flow.signs)
        last = self.flow.states + self.flow.inputs
        return self.y[last - elements : last].tolist(), self.y[-elements:].tolist()

    def guard_sizes(self) -> np.ndarray:
        """Return the sums of magnitudes behind the guards' coefficients, (guards, d+1)."""
        sizes = self.flow.sizes.dot(np.abs(self.y))
        return sizes.reshape(self.guards.shape[1], -1).T

    def nodes(self, end: float) -> list[float]:
        """Return nodes in (0, end], the last of them `end`, no farther apart than a step."""
        count = ceil(end * self.flow.steps)
        return [*(end * step / count for step in range(1, count)), end]

    def first_event(self, orders: list[int] | None, end: float) -> tuple[float, int | None]:
        """
        Return the time in [0, end] of the first guard that becomes negative, and its index.

        Without one the result is `end` and None. A guard of order k is zero at 0 with k - 1
        derivatives, so that its next root is that of the guard divided by t^k.
        """
        first, which = end, None
        nodes = self.nodes(end)
        for guard, powers in enumerate(self.guards.tolist()):
            at = first_negative(powers[orders[guard] :] if orders else powers, nodes)
            if at is not None and (which is None or at < first):
                first, which = at, guard
        return first, which

    def work(self, end: float) -> list[float]:
        """Return the integrals of c |s| over t from 0 to `end` of the slipping elements."""
        flow = self.flow
        capacities, changes = self.capacities()
        return [
            integral_with(self.guards[guard].tolist(), (capacities[i], changes[i]), end)
            for i, guard in zip(flow.slipping, flow.slip_guards, strict=True)
        ]


def _combined(factors: np.ndarray, terms: np.ndarray) -> np.ndarray:
    """Return the sums (..., i, j, k) over d of factors (i, d) times terms (..., d, j, k)."""
    flat = factors @ terms.reshape(*terms.shape[:-2], -1)
    return flat.reshape(*flat.shape[:-1], *terms.shape[-2:])


def balanced(a: np.ndarray) -> np.ndarray:
    """
    Return `a` (n, n) in other units of its states, with a 1-norm that is not above its own.

    LAPACK's balancing first leaves out the states that drive no other, such as angles, and does
    not count how these are driven. Where their driver hardly drives anything else, its unit is
    then set by that little alone, and the norm may grow without bound. All states are balanced
    together in this case, or the units stay.
    """
    # Only here: most of the graph's nodes do without scipy, whose import would double their start.
    from scipy.linalg.lapack import dgebal

    reduced = dgebal(a, scale=True, permute=True)[0]
    if _norm(reduced) <= min(_norm(a), LONGEST):
        return reduced
    return min(a, reduced, dgebal(a, scale=True)[0], key=_norm)


def _norm(matrix: np.ndarray) -> Any:
    """Return the 1-norm (...); `np.linalg.norm` takes three times as long for small matrices."""
    return np.abs(matrix).sum(axis=-2).max(axis=-1)
