"""Which mode goes on from an instant at which slips are zero."""

from collections.abc import Callable, Iterator, Mapping
from itertools import product

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.mode_flow import ModeFlow, Signs

SLACKS = (2.0**-44, 2.0**-34)
"""
A sum below this part of its terms is zero to rounding: the first decides, unless it leaves none.

It is asked at events only, so that no slip speed counts as zero while an element slips.
"""


def choose_mode(
    system: FrictionSystem,
    flows: Mapping[Signs, ModeFlow],
    state: np.ndarray,
    signs: Signs,
    element: int,
    inputs_of: Callable[[ModeFlow], np.ndarray],
) -> tuple[np.ndarray, Signs, np.ndarray]:
    """
    Return state, mode and orders of the guards with which the motion goes on.

    `element` has reached the end of `signs`, its mode; `inputs_of` gives [w, dw] for a mode. The
    elements at zero slip are tried in every combination of sticking and slipping either way. A
    combination is consistent if each of their guards has a positive first derivative that is not
    zero: of the margin capacity - |f|, or of the slip times its sign. That decides ties, as a
    release with equal capacities, where the acceleration of slip is zero. A guard that is zero
    with all derivatives lets an element stick, not slip. Few slipping elements come first: a
    static capacity above the kinetic one can leave several combinations. The one that the kinetic
    capacities alone would give is always among them, so that one is found.

    The slips of these elements become zero to the last bit. A guard's order is that of its first
    derivative that is not zero; below it the coefficients are rounding.
    """
    for slack in SLACKS:
        size = slack * np.abs(system.h) @ np.abs(state)
        at_zero = np.abs(system.h @ state) <= size
        at_zero |= np.array(signs) == 0
        at_zero[element] = True
        stuck = tuple(0 if zero else sign for zero, sign in zip(at_zero, signs, strict=True))
        projected = flows[stuck].projection @ state
        for candidate in _candidates(stuck, at_zero, element):
            flow = flows[candidate]
            y = np.concatenate([projected, inputs_of(flow)])
            orders = _orders(flow, y, at_zero, slack)
            if orders is not None:
                return projected, candidate, orders
    raise DdctError(
        f'friction: element {element} can neither stick nor slip in state {state.tolist()}: '
        'look for values that are not finite or far too large'
    )


def _candidates(stuck: Signs, at_zero: np.ndarray, element: int) -> Iterator[Signs]:
    """Yield the modes of the elements at zero slip, those with fewest slipping ones first."""
    choices = [(0, 1, -1) if zero else (sign,) for zero, sign in zip(at_zero, stuck, strict=True)]

    def slipping(signs: Signs) -> tuple[int, bool]:
        return sum(map(abs, signs)), signs[element] == 0

    yield from sorted(product(*choices), key=slipping)


def _orders(flow: ModeFlow, y: np.ndarray, at_zero: np.ndarray, slack: float) -> np.ndarray | None:
    """Return the order of each guard, d+1 if it is zero throughout, or None if inconsistent."""
    guards = flow.polynomials(y)[1]
    significant = np.abs(guards) > slack * flow.guard_sizes(y)
    orders = np.where(significant.any(axis=1), significant.argmax(axis=1), flow.degree + 1)
    for guard, element in enumerate(flow.guarded):
        if not at_zero[element]:
            orders[guard] = 0
        elif orders[guard] > flow.degree:
            if flow.signs[element]:
                return None
        elif guards[guard, orders[guard]] < 0.0:
            return None
    return orders
