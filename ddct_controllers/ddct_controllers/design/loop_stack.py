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

from ddct_controllers.design.delayed_input import delay_line
from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S, SUBSTEPS
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import hold_inputs


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
        return held.behind(delay_line(periods)) if periods else held

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
        system = self._triangular()
        total = np.repeat(system.d[:, np.newaxis].astype(complex), len(z), axis=1)
        x = np.repeat(system.b.T[..., np.newaxis], len(z), axis=2)
        for k in reversed(range(len(x))):
            for later in range(k + 1, len(x)):
                x[k] += system.a[:, k, later, np.newaxis] * x[later]
            x[k] /= z - system.a[:, k, k, np.newaxis]
            total += system.c[:, k, np.newaxis] * x[k]
        return total

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

    def _triangular(self) -> 'LoopStack':
        """
        Return the systems in coordinates in which their matrices are upper triangular, complex.

        Balanced first: a rotation would mix the rounding of large states into small ones.
        """
        upper = self.a.astype(complex)
        b, c = self.b.astype(complex), self.c.astype(complex)
        for i, a in enumerate(self.a if self.b.size else ()):
            balanced, (scale, _) = scipy.linalg.matrix_balance(a, permute=False, separate=True)
            upper[i], turned = scipy.linalg.schur(balanced, output='complex', check_finite=False)
            b[i], c[i] = (self.b[i] / scale) @ turned.conj(), (self.c[i] * scale) @ turned
        return LoopStack(upper, b, c, self.d)
