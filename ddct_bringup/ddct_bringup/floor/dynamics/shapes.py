# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Shapes of the off-going clutch's torque over a period: polynomials, effects and bounds."""

import math
from functools import lru_cache

import numpy as np

from ddct_bringup.floor.dynamics.propagators import ENGINE, SHAFT
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.sampling import hold_inputs
from ddct_plant.models.driveline_model import states_and_torques
from ddct_plant.shift.gear_pair import GearPair

SHAPES = 4
"""Number of Legendre polynomials that C_1 has over a period: with these any effect on the four
states is that of one sum of them."""
_LEGENDRE = ((1.0,), (-1.0, 2.0), (1.0, -6.0, 6.0), (-1.0, 12.0, -30.0, 20.0))
"""Coefficients of the polynomials on [0, 1], the constant first."""
_PARTS = 100
"""Parts of a period in the sums that bound the coefficients."""
_PADDING = 1.0 + 1e-3
"""Factor of these bounds, more than what a sum of so many parts can lack."""
_ROUNDING = 5e-3
"""Rounding of coefficients in N m that are computed from recorded states."""


@lru_cache
def shape_effects(gears: GearPair) -> np.ndarray:
    """
    Return what the Legendre polynomials of C_1 in 1 N m add to the states over a period, (4, 4).

    The column of C_1 in the equations is -1/J_m for the engine and r/(J_p (1 + r^2)) for the
    on-coming shaft.
    """
    a, b = _matrices(gears)
    chain = np.zeros((7, 7))
    chain[:4, :4], chain[:4, 4] = a, b
    chain[4, 5] = chain[5, 6] = 1.0
    last = np.zeros((7, 1))
    last[6] = 1.0
    transition, held = hold_inputs(chain, last, PERIOD_S)
    # Of the inputs t^n / n!; the polynomials are in t/T.
    powers = np.column_stack([transition[:4, 4:], held[:4]])
    scaled = powers * [math.factorial(order) / PERIOD_S**order for order in range(SHAPES)]
    coefficients = np.zeros((SHAPES, SHAPES))
    for place, polynomial in enumerate(_LEGENDRE):
        coefficients[: len(polynomial), place] = polynomial
    return np.asarray(scaled @ coefficients)


def _matrices(gears: GearPair) -> tuple[np.ndarray, np.ndarray]:
    """Return a (4, 4) of both engaged gears, and the column (4,) of C_1."""
    p = gears.both_engaged
    a, _ = states_and_torques(p)
    column = np.zeros(4)
    column[ENGINE] = -1.0 / p.engine_inertia
    column[SHAFT] = gears.ratio / p.shaft_inertia
    return a, column


def most_shapes(gears: GearPair, capacity: np.ndarray) -> np.ndarray:
    """
    Return the largest coefficients (n, 4) of a torque within capacities (n, 11) in N m.

    The effect of C_1 on the states is the integral of a kernel k(s) times C_1(s). With the
    effects E of the polynomials the coefficients are that of E^-1 k(s) C_1(s), so that their size
    is at most the integral of |E^-1 k(s)| times the capacity.
    """
    a, column = _matrices(gears)
    step = hold_inputs(a, column[:, np.newaxis], PERIOD_S / _PARTS)[0]
    kernel = [column]
    for _ in range(_PARTS):
        kernel.append(step @ kernel[-1])
    sizes = np.abs(np.linalg.solve(shape_effects(gears), np.array(kernel[::-1]).T))
    shares = np.linspace(0.0, SUBSTEPS, _PARTS + 1)
    nodes = np.arange(SUBSTEPS + 1)
    torques = np.empty((len(capacity), len(shares)))
    for place, each in enumerate(capacity):
        torques[place] = np.interp(shares, nodes, each)
    greatest = np.maximum(sizes[:, :-1], sizes[:, 1:])
    carried = np.maximum(torques[:, :-1], torques[:, 1:])
    return np.asarray(_PADDING * PERIOD_S / _PARTS * carried @ greatest.T + _ROUNDING)
