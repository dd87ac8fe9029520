"""The exact flow of one mode: which elements stick, which slip, and which way."""

from typing import NamedTuple

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.hybrid.friction_system import FrictionSystem, Signs
from ddct_plant.hybrid.polynomials import (
    bernstein_of_powers,
    first_negative,
    linear_weights,
    on_interval,
)

LONGEST = 2.0
"""A piece may be this long in units of 1 / (the balanced norm of a)."""


def _projection(system: FrictionSystem, signs: Signs) -> tuple[np.ndarray, np.ndarray]:
    """Return P (n, n), which takes the slip of the stuck elements away, and (h_S g_S)^-1 h_S."""
    stuck = [i for i, sign in enumerate(signs) if sign == 0]
    rows, columns = system.h[stuck], system.g[:, stuck]
    hold = np.linalg.solve(rows @ columns, rows)
    return np.eye(len(system.a)) - columns @ hold, hold


class ModeFlow:
    """
    exp(M t) as a series, in one mode: of states, and of guards that are positive as it lasts.

    y = [x, w, dw] holds the states, the inputs w = [u, c] (c the kinetic capacity of an element
    that slips, the static one of an element that sticks) and their change over one piece. With
    t from 0 to 1 over the piece dy/dt = M y is autonomous: dx = piece (P a x + P [b, g sign] w),
    w' = dw. Guards: the slip times its sign; c - f and c + f of an element that sticks.
    """

    def __init__(self, system: FrictionSystem, signs: Signs, piece_s: float) -> None:
        self.signs = signs
        states, inputs = system.b.shape
        self.states, self.inputs = states, inputs + system.elements
        self.projection, hold = _projection(system, signs)
        self.degree = _series_degree(self.projection @ system.a, piece_s)
        driven = np.hstack([system.b, system.g * signs])
        moved = np.hstack([system.a, driven])
        self.stuck = np.array(signs) == 0
        size = states + 2 * self.inputs
        generator = np.zeros((size, size))
        generator[:states, : states + self.inputs] = piece_s * self.projection @ moved
        generator[states : states + self.inputs, states + self.inputs :] = np.eye(self.inputs)
        self.force = np.zeros((system.elements, states + self.inputs))
        """(N, n + w): the friction torques as rows on [x, w]."""
        self.force[:, states + inputs :] = np.diag(signs)
        self.force[self.stuck] = -hold @ moved
        guards, self.guarded = self._guards(system)
        self.slipping = [i for i, sign in enumerate(signs) if sign]
        """The elements that slip."""
        self.slip_guards = [self.guarded.index(i) for i in self.slipping]
        rows = np.zeros((states + len(guards), size))
        rows[:states, :states] = self.projection
        rows[states:, : states + self.inputs] = guards
        powers = [rows]
        for order in range(1, self.degree + 1):
            powers.append(powers[-1] @ generator / order)
        self.series = np.array(powers)
        self.powers = np.arange(self.degree + 1)
        """0, 1, ..., d."""
        self._series = self.series.reshape(-1, size)
        # Instants are known to rounding of a piece, so y to that of how much it changes in one.
        within = np.eye(size) + np.abs(generator)
        self.sizes = np.abs(self.series[:, states:]).reshape(-1, size) @ within
        powers_of_guards = np.moveaxis(self.series[:, states:], 0, 1)
        self.guards = bernstein_of_powers(self.degree) @ powers_of_guards
        """(guards, d+1, y): their Bernstein coefficients over a whole piece, as rows on y."""
        self.end = self.series[:, :states].sum(axis=0)
        """(n, y): the state after a piece."""

    def _guards(self, system: FrictionSystem) -> tuple[np.ndarray, list[int]]:
        """Return the rows of the guards on [x, w], and by guard its element."""
        rows: list[np.ndarray] = []
        guarded: list[int] = []
        capacities = np.eye(self.states + self.inputs)[-system.elements :]
        for i, sign in enumerate(self.signs):
            if sign:
                slip = np.zeros(self.states + self.inputs)
                slip[: self.states] = sign * system.h[i]
                rows.append(slip)
            else:
                rows += [capacities[i] - self.force[i], capacities[i] + self.force[i]]
            guarded += [i] * (len(rows) - len(guarded))
        return np.array(rows), guarded

    def slip_integrals(self, guards: np.ndarray) -> np.ndarray:
        """
        Return (slipping elements, 2): the integrals of |s| (1 - t) and |s| t over [0, 1].

        `guards` (guards, d+1) are in Bernstein form.
        """
        return guards[self.slip_guards].dot(linear_weights(self.degree).T)

    def course(self, state: np.ndarray, forcing: np.ndarray) -> 'Course':
        """Return the motion from a state (n,) on, driven by [w, dw] (2 w,)."""
        y = np.concatenate((state, forcing))
        values = self._series.dot(y).reshape(self.degree + 1, -1)
        return Course(self, y, values[:, : self.states], values[:, self.states :].T)


class Course(NamedTuple):
    """The motion in one mode from an instant on, as polynomials in t, in lengths of a piece."""

    flow: ModeFlow
    y: np.ndarray
    """State at t = 0."""
    states: np.ndarray
    """(d+1, n) coefficients of t^k."""
    guards: np.ndarray
    """(guards, d+1) coefficients of t^k."""

    def at(self, part: float) -> np.ndarray:
        """Return the state (n,) at t = `part`."""
        return (part**self.flow.powers).dot(self.states)

    def slip_slope(self, element: int, part: float) -> float:
        """Return the slope over a piece of the slip of an element that slips, at t = `part`."""
        flow = self.flow
        coefficients = self.guards[flow.guarded.index(element)].tolist()
        slope = 0.0
        for order in range(flow.degree, 0, -1):
            slope = slope * part + order * coefficients[order]
        return flow.signs[element] * slope + 0.0  # no zero with a sign

    def capacities(self) -> tuple[list[float], list[float]]:
        """Return those in force at t = 0, and their change over a piece, (N,) each."""
        elements = len(self.flow.signs)
        last = self.flow.states + self.flow.inputs
        return self.y[last - elements : last].tolist(), self.y[-elements:].tolist()

    def guard_sizes(self) -> np.ndarray:
        """Return (guards, d+1): how large the sums are whose rounding the coefficients have."""
        sizes = self.flow.sizes.dot(np.abs(self.y))
        return sizes.reshape(self.guards.shape[1], -1).T

    def first_event(
        self, orders: list[int] | None, end: float
    ) -> tuple[float, int | None, np.ndarray]:
        """
        Return when within [0, end] the first guard turns negative, and which; or `end` and None.

        The third are the guards in Bernstein form up to then. A guard of order k is zero at 0 with
        k - 1 derivatives, so that its next root is that of the guard divided by t^k.
        """
        first, which = end, None
        coefficients = on_interval(self.guards, end)
        for guard, least in enumerate(coefficients.min(axis=1).tolist()):
            if least < 0.0:
                order = orders[guard] if orders else 0
                at = first_negative(self.guards[guard, order:], end)
                if at is not None and (which is None or at < first):
                    first, which = at, guard
        if which is not None:
            coefficients = on_interval(self.guards, first)
        return first, which, coefficients


def _series_degree(a: np.ndarray, piece_s: float) -> int:
    """Return the order from which on the terms of exp(a piece) are below rounding."""
    # Only here: most of the graph's nodes do without scipy, whose import would double their start.
    from scipy.linalg import matrix_balance

    balanced = matrix_balance(a * piece_s)[0]
    size = float(np.linalg.norm(balanced, 1))
    if size > LONGEST:
        raise ParameterError(
            f'friction system: it has rates of {size / piece_s:g} rad/s: take pieces of at most '
            f'{LONGEST * piece_s / size:.3g} s in place of {piece_s:g} s'
        )
    degree, term = 2, balanced @ balanced / 2.0
    while np.linalg.norm(term, 1) > 2.0**-53:
        degree += 1
        term = term @ balanced / degree
    return degree
