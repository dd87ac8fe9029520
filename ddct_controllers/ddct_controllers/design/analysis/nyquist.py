# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The Nyquist criterion P_cl = P_ol + N of Section 2.2.1, by counted encirclements."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_controllers.design.state_space import close_loop
from ddct_plant.base.errors import DdctError, ParameterError

_INDENTATION_RAD_S = 1e-6
"""
Radius in rad/s of the half circles past poles on the imaginary axis.

A closed-loop pole within one would be missed: one that the loop hardly moves off the axis.
"""
_ON_AXIS = 1e-9
"""Real part, relative to the magnitude, below which a closed-loop pole is on the axis."""


@dataclass(frozen=True)
class NyquistCount:
    """Numbers of the Nyquist criterion for a loop."""

    open_loop_unstable: int
    """Number P_ol of poles of L with positive real part."""
    encirclements: int
    """Number N of encirclements of -1 for w from -inf to inf: clockwise less counterclockwise."""

    @property
    def closed_loop_unstable(self) -> int:
        """Number P_cl of roots of 1 + L with positive real part."""
        return self.open_loop_unstable + self.encirclements


def nyquist_count(loop: ContinuousLoop) -> NyquistCount:
    """
    Count the encirclements of -1 by a strictly proper L without dead time.

    The contour passes poles on the imaginary axis on the right, so that they count as stable.
    Raise ParameterError when L is not strictly proper or has a dead time, DdctError when the
    curve passes through -1.
    """
    factored = loop.transfer_function
    if len(factored.zeros) >= len(factored.poles):
        raise ParameterError('Nyquist count: L(s) must have more poles than zeros')
    system = loop.to_state_space()
    closed = np.linalg.eigvals(close_loop(system).a)
    if np.any(np.abs(closed.real) <= _ON_AXIS * np.abs(closed)):
        raise DdctError('Nyquist count: L(jw) passes through -1: change the gain a little')
    import control  # takes a second

    theirs = control.ss(system.a, system.b, system.c, system.d)
    curve = control.nyquist_response(theirs, indent_radius=_INDENTATION_RAD_S)
    return NyquistCount(int(np.count_nonzero(factored.poles.real > 0.0)), int(curve.count))
