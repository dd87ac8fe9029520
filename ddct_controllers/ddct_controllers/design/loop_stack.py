# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Many linear systems of equal order at once, each with one input and one output.

The first axis is that of the systems. No product is over this axis, so a system has the same
numbers to the last bit whatever stands beside it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy

from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S, SUBSTEPS
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import hold_inputs

_AT_ONCE = 1600
"""Number of matrices that are solved together, so that they stay in the processor's cache."""


@dataclass(frozen=True, eq=False)
class LoopStack:
    """R systems with n states, continuous, or sampled at 10 ms."""

    a: np.ndarray
    """State matrices, (R, n, n)."""
    b: np.ndarray
    """Input columns, (R, n)."""
    c: np.ndarray
    """Output rows, (R, n)."""
    d: np.ndarray
    """Feedthroughs, (R,)."""

    @classmethod
    def joined(cls, systems: Sequence[StateSpace]) -> Self:
        """Return the stack of systems of equal order, each with one input and one output."""
        parts = [(each.a, each.b[:, 0], each.c[0], each.d[0, 0]) for each in systems]
        return cls(*(np.array(part) for part in zip(*parts, strict=True)))

    def __len__(self) -> int:
        """Return the number of systems."""
        return len(self.a)

    def sampled(self, place: int) -> StateSpace:
        """Return one system of a stack of systems that are sampled at 10 ms."""
        b, c, d = self.b[place, :, np.newaxis], self.c[place : place + 1], self.d[place]
        return StateSpace(self.a[place], b, c, d.reshape(1, 1), PERIOD_S)

    def some(self, places: np.ndarray) -> 'LoopStack':
        """Return the stack of the systems at `places`, (k,), which may repeat."""
        return LoopStack(self.a[places], self.b[places], self.c[places], self.d[places])

    def behind(self, first: StateSpace) -> 'LoopStack':
        """Return each system behind another, `first`, whose states come first: `series`."""
        count, states, order = len(self), len(self.b[0]), len(first.a)
        a = np.zeros((count, order + states, order + states))
        a[:, :order, :order] = first.a
        a[:, order:, :order] = self.b[:, :, np.newaxis] * first.c[0]
        a[:, order:, order:] = self.a
        through = first.d[0, 0]
        own = np.broadcast_to(first.b[:, 0], (count, order))
        b = np.concatenate([own, self.b * through], axis=1)
        c = np.concatenate([self.d[:, np.newaxis] * first.c[0], self.c], axis=1)
        return LoopStack(a, b, c, self.d * through)

    def behind_delay(self, substeps: int) -> 'LoopStack':
        """Return continuous systems, sampled, behind a delay: `sampled_behind_delay`."""
        periods, late = divmod(substeps, SUBSTEPS)
        held = self._changed_within_period(late) if late else self._held(PERIOD_S)
        return held.behind(_delay_line(periods)) if periods else held

    def closed(self, gains: np.ndarray) -> np.ndarray:
        """
        Return the state matrices (R, k, n, n) of the loops closed by negative feedback.

        `gains`, (k,), multiply the loops.
        """
        share = gains / (1.0 + gains * self.d[:, np.newaxis])
        back = self.b[:, np.newaxis, :, np.newaxis] * self.c[:, np.newaxis, np.newaxis]
        return self.a[:, np.newaxis] - back * share[:, :, np.newaxis, np.newaxis]

    def responses(self, omega: np.ndarray) -> np.ndarray:
        """Return the complex responses (R, m) of sampled systems at m frequencies in rad/s."""
        z = np.exp(1j * omega * PERIOD_S)
        each = max(1, _AT_ONCE // len(z))
        reduced = self._reduced()
        found = [_responses(reduced, z, slice(i, i + each)) for i in range(0, len(self), each)]
        return np.concatenate(found)

    def pointwise(self, omega: np.ndarray) -> np.ndarray:
        """Return the complex response (R,) of each sampled system at its own frequency, (R,)."""
        z = np.exp(1j * omega * PERIOD_S)
        resolvents = z[:, np.newaxis, np.newaxis] * np.eye(self.a.shape[1]) - self.a
        states = np.linalg.solve(resolvents, self.b[:, :, np.newaxis])[..., 0]
        return (self.c * states).sum(axis=1) + self.d

    def _held(self, period_s: float) -> 'LoopStack':
        a, b = hold_inputs(self.a, self.b[..., np.newaxis], period_s)
        return LoopStack(a, b[..., 0], self.c, self.d)

    def _changed_within_period(self, late: int) -> 'LoopStack':
        """Return the systems whose input changes `late` ms after each sample."""
        first, rest = self._held(late * SUBSTEP_S), self._held((SUBSTEPS - late) * SUBSTEP_S)
        count, states = self.b.shape
        a = np.zeros((count, 1 + states, 1 + states))
        a[:, 1:, 0] = (rest.a @ first.b[..., np.newaxis])[..., 0]
        a[:, 1:, 1:] = self._held(PERIOD_S).a
        b = np.concatenate([np.ones((count, 1)), rest.b], axis=1)
        c = np.concatenate([self.d[:, np.newaxis], self.c], axis=1)
        return LoopStack(a, b, c, np.zeros(count))

    def _reduced(self) -> 'LoopStack':
        """
        Return the systems in coordinates in which their matrices are upper Hessenberg.

        Balanced first: a rotation would mix the rounding of large states into small ones.
        """
        if self.a.shape[1] < 3:
            return self
        upper, b, c = np.empty_like(self.a), np.empty_like(self.b), np.empty_like(self.c)
        for i, a in enumerate(self.a):
            balanced, (scale, _) = scipy.linalg.matrix_balance(a, permute=False, separate=True)
            upper[i], turned = scipy.linalg.hessenberg(balanced, calc_q=True, check_finite=False)
            b[i], c[i] = (self.b[i] / scale) @ turned, (self.c[i] * scale) @ turned
        return LoopStack(upper, b, c, self.d)


def _delay_line(periods: int) -> StateSpace:
    inputs = np.eye(periods)
    shift = np.eye(periods, k=-1)
    return StateSpace(shift, inputs[:, :1], inputs[-1:], np.zeros((1, 1)), PERIOD_S)


def _responses(systems: LoopStack, z: np.ndarray, which: slice) -> np.ndarray:
    """
    Return c (z - H)^-1 b + d, (R, m), of some systems with upper Hessenberg matrices H.

    Gaussian elimination of all (z - H) at once, with the larger of two rows as pivot.
    """
    upper, b = systems.a[which], systems.b[which]
    states, shape = b.shape[1], (len(b), len(z))
    rows = -np.broadcast_to(upper.transpose(1, 2, 0)[..., np.newaxis], (states, states, *shape))
    rows = rows.astype(complex)
    rows[np.arange(states), np.arange(states)] += z
    x = np.broadcast_to(b.T[..., np.newaxis], (states, *shape)).astype(complex)
    for k in range(states - 1):
        swap = _size(rows[k + 1, k]) > _size(rows[k, k])
        pivot = np.where(swap, rows[k + 1, k:], rows[k, k:])
        other = np.where(swap, rows[k, k:], rows[k + 1, k:])
        of_pivot, of_other = np.where(swap, x[k + 1], x[k]), np.where(swap, x[k], x[k + 1])
        factor = other[0] / pivot[0]
        rows[k, k:], rows[k + 1, k:] = pivot, other - factor * pivot
        x[k], x[k + 1] = of_pivot, of_other - factor * of_pivot
    for k in reversed(range(states)):
        for later in range(k + 1, states):
            x[k] -= rows[k, later] * x[later]
        x[k] /= rows[k, k]
    outputs = systems.c[which].T[..., np.newaxis] * x
    return outputs.sum(axis=0) + systems.d[which, np.newaxis]


def _size(values: np.ndarray) -> np.ndarray:
    """Return a magnitude of complex values that costs less than the absolute one."""
    return np.abs(values.real) + np.abs(values.imag)
