# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Choice of the mode after an instant at which slips are zero."""

from collections.abc import Callable, Mapping
from functools import lru_cache
from itertools import product

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.hybrid.friction_system import FrictionSystem, Signs
from ddct_plant.hybrid.mode_flow import Course, ModeFlow

SLACKS = (2.0**-44, 2.0**-34)
"""
Sum that counts as zero, over its terms: the first is used unless no mode is consistent with it.

They are used at events only, so that no slip speed counts as zero while an element slips.
"""


def choose_mode(
    system: FrictionSystem,
    flows: Mapping[Signs, ModeFlow],
    state: np.ndarray,
    signs: Signs,
    element: int,
    forcing_in: Callable[[Signs], np.ndarray],
) -> tuple[Course, list[int]]:
    """
    Return the course after the event, and the orders of its guards.

    `element` has reached the end of `signs`, its mode; `forcing_in` gives [w, dw] in a mode. The
    elements at zero slip are tried in every combination of sticking and slipping either way. A
    combination is consistent if each of their guards has a positive first derivative that is not
    zero: of the margin capacity - |f|, or of the slip times its sign. That decides ties, as a
    release with equal capacities, where the acceleration of slip is zero. A guard that is zero
    with all derivatives lets an element stick, not slip. Few slipping elements come first: a
    static capacity above the kinetic one can leave several combinations. The one that the kinetic
    capacities alone would give is always among them, so that one is found.

    The slips of these elements become zero to the last bit. A guard's order is that of its first
    derivative that is not zero; below it the coefficients are rounding, and become zero.
    """
    slips = np.abs(system.h.dot(state)).tolist()
    sizes = system.size_of_h.dot(np.abs(state)).tolist()
    for slack in SLACKS:
        stuck = tuple(
            0 if i == element or slip <= slack * size else sign
            for i, (sign, slip, size) in enumerate(zip(signs, slips, sizes, strict=True))
        )
        projected = flows[stuck].projection.dot(state)
        for candidate in _candidates(stuck, element):
            course = flows[candidate].course(projected, forcing_in(candidate))
            orders = _orders(course, stuck, slack)
            if orders is not None:
                return course, orders
    raise DdctError(
        f'friction: element {element} can neither stick nor slip in state {state.tolist()}: '
        'look for values that are not finite or far too large'
    )


@lru_cache
def _candidates(stuck: Signs, element: int) -> list[Signs]:
    """Return the candidate modes of the elements at zero slip, fewest slipping elements first."""

    def slipping(signs: Signs) -> tuple[int, bool]:
        return sum(map(abs, signs)), signs[element] == 0

    choices = [(sign,) if sign else (0, 1, -1) for sign in stuck]
    return sorted(product(*choices), key=slipping)


def _orders(course: Course, stuck: Signs, slack: float) -> list[int] | None:
    """Return the order of each guard, d+1 if it is zero throughout, or None for a refused mode."""
    flow, guards = course.flow, course.guards
    significant = np.abs(guards) > slack * course.guard_sizes()
    orders = []
    for guard, (element, known) in enumerate(zip(flow.guarded, significant.tolist(), strict=True)):
        if stuck[element]:
            orders.append(0)
            continue
        order = known.index(True) if True in known else flow.degree + 1
        if order > flow.degree:
            if flow.signs[element]:
                return None
        elif guards[guard, order] < 0.0:
            return None
        guards[guard, :order] = 0.0
        orders.append(order)
    return orders
