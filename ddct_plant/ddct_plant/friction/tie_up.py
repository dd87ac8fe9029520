# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Work that the two clutches of a shift do against each other, exact as the motion is."""

from collections.abc import Sequence
from itertools import pairwise
from operator import add

import numpy as np

from ddct_plant.base.timebase import SUBSTEP_S, SUBSTEPS
from ddct_plant.friction.engagements import OFF_GOING, ON_COMING, SHIFT_STATES, EngagedGears
from ddct_plant.hybrid.interval_map import Interval
from ddct_plant.hybrid.mode_flow import Course
from ddct_plant.hybrid.polynomials import sign_changes, value_at

_SHAFT, _OTHER = SHIFT_STATES.places('shaft_speed', 'off_going_speed')
_CLUTCHES = slice(ON_COMING, OFF_GOING + 1)
_CAPACITIES = tuple(
    slice(element * (SUBSTEPS + 1), (element + 1) * (SUBSTEPS + 1))
    for element in (ON_COMING, OFF_GOING)
)
"""Slices of the nodes of both clutches in a list of capacities."""


class TieUp:
    """
    Tie-up work of a period: the integral of min(|C_1|, |C_2|) |w_p1 - w_p2| while C_1 C_2 < 0.

    While the torques of the clutches have opposite signs, the smaller magnitude of them goes in a
    circle through both gears, and the wheels lose this work. Torques and speeds are polynomials in
    time between nodes and events, so the integral is exact to rounding.
    """

    def __init__(self, engaged: EngagedGears) -> None:
        """Prepare for these engaged gears."""
        self._integrator = engaged.integrator
        units = np.eye(len(engaged.integrator.system.a))
        values = np.array([engaged.to_values(unit.tolist()) for unit in units])
        self._difference = values[:, _OTHER] - values[:, _SHAFT]
        """Row (n,) from the state to w_p1 - w_p2."""

    def work(
        self,
        before: Interval,
        after: Interval,
        inputs: Sequence[float],
        kinetic: Sequence[float],
        static: Sequence[float],
    ) -> float:
        """
        Return the work in J between two results of the integrator that are a period apart.

        `inputs`, `kinetic` and `static` are those with which the integrator went from one to the
        other; without the courses of `after` it goes there again.
        """
        one, other = _CAPACITIES
        if not (max(static[one]) > 0.0 and max(static[other]) > 0.0):
            return 0.0
        given = before.state, before.signs, inputs, kinetic, static
        if not after.events:
            signs = self._integrator.friction_signs(*given)
            if signs[ON_COMING] * signs[OFF_GOING] > 0:
                return 0.0
        courses = after.courses or self._integrator.courses(*given)
        return SUBSTEP_S * sum(self._over(course, part) for course, part in courses)

    def _over(self, course: Course, part: float) -> float:
        """Return the integral over t from 0 to `part`, in N m rad/s."""
        one, other = torques = course.friction()[_CLUTCHES].tolist()
        difference = course.states.dot(self._difference).tolist()
        changing = *torques, list(map(add, one, other)), difference
        nodes = course.nodes(part)
        roots = (root for each in changing for root in sign_changes(each, nodes))
        ends = sorted({0.0, part, *roots})
        return sum(_opposing(torques, difference, *span) for span in pairwise(ends))


def _opposing(
    torques: Sequence[Sequence[float]], difference: Sequence[float], start: float, end: float
) -> float:
    """
    Return the integral over t from `start` to `end` where neither torque is zero within.

    Both torques and the difference of the speeds are coefficients of t^k. Between `start` and
    `end` one torque stays the smaller one, and the difference keeps its sign.
    """
    one, other = (value_at(torque, 0.5 * (start + end)) for torque in torques)
    if one * other >= 0.0:
        return 0.0
    smaller = torques[0] if abs(one) < abs(other) else torques[1]
    power = np.convolve(smaller, difference)
    work = [0.0, *(power / np.arange(1.0, len(power) + 1.0)).tolist()]
    return abs(value_at(work, end) - value_at(work, start))
