"""The motion from event to event."""

from collections.abc import Mapping
from functools import partial
from math import isfinite

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.hybrid.forcing import Forcing, Signs
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.interval_map import Event, Interval, IntervalMap
from ddct_plant.hybrid.mode_choice import choose_mode
from ddct_plant.hybrid.mode_flow import Course, ModeFlow
from ddct_plant.hybrid.polynomials import first_negative, on_interval

MOST_EVENTS = 1000
"""Most events in one piece. Dry friction between inertias gives fewer."""


class Motion:
    """State, mode, events and friction work as they come about in an interval with events."""

    def __init__(
        self,
        system: FrictionSystem,
        flows: Mapping[Signs, ModeFlow],
        maps: Mapping[Signs, IntervalMap],
        piece_s: float,
        forcing: Forcing,
        state: np.ndarray,
        signs: Signs,
    ) -> None:
        self._system, self._flows, self._maps = system, flows, maps
        self._piece_s, self._forcing = piece_s, forcing
        self._state, self._signs = state, signs
        self._events: list[Event] = []
        self._work = [0.0] * system.elements

    def to_the_end(self) -> Interval:
        """Go on to the end of the interval."""
        piece, pieces = 0, self._forcing.layout.pieces
        while piece < pieces:
            piece = self._pass_pieces(piece)
            if piece < pieces:
                self._through_events(piece)
                piece += 1
        flow = self._flows[self._signs]
        w = self._forcing.at(self._signs, pieces - 1, 1.0)[: flow.inputs]
        friction = flow.force.dot(np.concatenate((self._state, w)))
        return Interval(
            self._state.tolist(), self._signs, self._events, self._work, friction.tolist()
        )

    def _pass_pieces(self, first: int) -> int:
        """Go on to the next piece in which there is an event; return its number."""
        layout, flow = self._forcing.layout, self._flows[self._signs]
        values = self._forcing.values(self._signs)
        passage = self._maps[self._signs].by_piece(
            np.concatenate((self._state, values[layout.shifts[first]]))
        )
        count = min(passage.lasts, layout.pieces - first)
        if count:
            self._state = passage.ends[count - 1]
            nodes = values[layout.nodes[first : first + count + 1]]
            for place, element in enumerate(flow.slipping):
                capacities = nodes[:, element - len(self._signs)]
                before, after = passage.slips[:count, place].T
                self._work[element] += float(
                    before.dot(capacities[:-1]) + after.dot(capacities[1:])
                )
        return first + count

    def _through_events(self, piece: int) -> None:
        """Go on to the end of a piece from event to event."""
        done = 0.0
        orders: list[int] | None = None
        course = self._flows[self._signs].course(
            self._state, self._forcing.at(self._signs, piece, 0.0)
        )
        for _ in range(MOST_EVENTS):
            if not isfinite(course.states.sum()):
                raise DdctError(
                    'friction: a state, an input or a capacity is not finite or far too large'
                )
            part, guard, guards = _first_event(course, orders, 1.0 - done)
            self._add_work(course, guards, part)
            self._state = course.at(part)
            done += part
            if guard is None:
                return
            course, orders = choose_mode(
                self._system,
                self._flows,
                self._state,
                self._signs,
                course.flow.guarded[guard],
                partial(self._forcing.at, piece=piece, part=done),
            )
            self._note_change((piece + done) * self._piece_s, course.flow.signs)
        raise DdctError(
            f'friction: more than {MOST_EVENTS} events in {self._piece_s:g} s: '
            'look for values that are far too large'
        )

    def _add_work(self, course: Course, guards: np.ndarray, part: float) -> None:
        """Add slip times capacity over a part of a piece; `guards` in Bernstein form on it."""
        flow = course.flow
        capacities, changes = course.capacities()
        for element, (before, after) in zip(
            flow.slipping, flow.slip_integrals(guards).tolist(), strict=True
        ):
            work = (before + after) * capacities[element] + after * part * changes[element]
            self._work[element] += part * self._piece_s * work

    def _note_change(self, time_s: float, signs: Signs) -> None:
        """Take the new mode, and note what changes."""
        for i, (old, new) in enumerate(zip(self._signs, signs, strict=True)):
            if old != new:
                kind = 'lock' if new == 0 else 'release' if old == 0 else 'reverse'
                self._events.append(Event(time_s, i, kind))
        self._signs = signs


def _first_event(
    course: Course, orders: list[int] | None, end: float
) -> tuple[float, int | None, np.ndarray]:
    """
    Return when within [0, end] the first guard turns negative, and which; or `end` and None.

    The third are the guards in Bernstein form up to then. A guard of order k is zero at 0 with
    k - 1 derivatives, so that its next root is that of the guard divided by t^k.
    """
    first, which = end, None
    coefficients = on_interval(course.guards, end)
    for guard, least in enumerate(coefficients.min(axis=1).tolist()):
        if least < 0.0:
            order = orders[guard] if orders else 0
            at = first_negative(course.guards[guard, order:], end)
            if at is not None and (which is None or at < first):
                first, which = at, guard
    if which is not None:
        coefficients = on_interval(course.guards, first)
    return first, which, coefficients
