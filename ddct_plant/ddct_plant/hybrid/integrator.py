# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The exact integration of a linear system with dry friction, from event to event."""

import struct
from collections import defaultdict
from collections.abc import Callable, Sequence
from functools import partial
from itertools import product
from math import isfinite
from typing import TypeVar
from weakref import WeakMethod

import numpy as np

from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.hybrid.friction_system import (
    Forcing,
    FrictionSystem,
    IntervalLayout,
    Signs,
    Values,
)
from ddct_plant.hybrid.interval_map import Event, Interval, IntervalMap
from ddct_plant.hybrid.mode_choice import choose_mode
from ddct_plant.hybrid.mode_flow import Course, HeldElements, ModeFlow, extents

Made = TypeVar('Made')
MOST_EVENTS = 1000
"""Most events in one piece; dry friction between inertias gives fewer."""
TOGETHER = 64
"""Systems whose modes are prepared together; the matrices of more leave the processor's cache."""


class _Modes(dict[Signs, Made]):
    """Results of a function of the mode, each of which is made when it is first needed."""

    def __init__(self, make: Callable[[Signs], Made]) -> None:
        # Weak, so that an integrator and what it holds go with its last user.
        self._make = WeakMethod(make)

    def __missing__(self, signs: Signs) -> Made:
        make = self._make()
        assert make is not None, 'its owner is there'
        made = self[signs] = make(signs)
        return made


class HybridIntegrator:
    """
    Integrator of a FrictionSystem over intervals of equal pieces, in which inputs are linear.

    Between events a mode's flow is a matrix exponential, taken by its series, which is exact to
    rounding over one piece. Slips and margins are then polynomials in time, the guards. One
    product gives the new state together with the guards and their tangents at nodes of the
    interval; if none is negative there is no event. Otherwise another gives them with the state
    after each piece. In the first piece that has a negative one the first root is found on the
    polynomials, and the motion goes on from there in the mode that `choose_mode` gives.

    It has no state of a motion, so that threads and runs may share it.
    """

    def __init__(
        self,
        system: FrictionSystem,
        piece_s: float,
        pieces: int,
        held: Sequence[int] = (),
    ) -> None:
        """
        Prepare for a system; `held` lists the entries of [u, c] that are held over an interval.

        Raise ParameterError where the rates of a mode are too fast for the pieces.
        """
        self.system = system
        self.piece_s = require_number('piece_s', piece_s, above=0.0)
        count = int(require_number('pieces', pieces, at_least=1))
        self.layout = IntervalLayout(system.b.shape[1], system.elements, count, held)
        """Positions of inputs and capacities in the values of an interval."""
        # A third faster than numpy, which inspects every value before it makes an array.
        self._pack = struct.Struct(f'{len(system.a) + self.layout.width}d').pack
        self._stuck = {
            stuck: HeldElements(system, stuck, self.piece_s)
            for stuck in product((False, True), repeat=system.elements)
        }
        self.flows = _Modes(self._flow)
        """Flow of each mode."""
        self.maps = _Modes(self._map)
        """Map of each mode over an interval."""

    def _held(self, signs: Signs) -> HeldElements:
        return self._stuck[tuple(not sign for sign in signs)]

    def _flow(self, signs: Signs) -> ModeFlow:
        return ModeFlow(self._held(signs), signs)

    def _map(self, signs: Signs) -> IntervalMap:
        return IntervalMap(self.flows[signs], self.piece_s, self.layout)

    @staticmethod
    def prepare(integrators: Sequence['HybridIntegrator'], signs: Signs) -> None:
        """Prepare a mode of many integrators at once, whose systems and intervals are alike."""
        lacking = list({id(each): each for each in integrators if signs not in each.maps}.values())
        for first in range(0, len(lacking), TOGETHER):
            some = lacking[first : first + TOGETHER]
            held = [each._held(signs) for each in some]
            alike = defaultdict(list)
            for each, elements, extent in zip(some, held, extents(held), strict=True):
                elements.extent = extent
                alike[extent].append(each)
            for members in alike.values():
                _prepare_alike(members, signs)

    def advance(
        self,
        state: Values,
        signs: Signs,
        inputs: Values,
        kinetic: Values,
        static: Values,
        keep: bool = False,
    ) -> Interval:
        """
        Integrate one interval from `state` (n,) in the mode `signs`.

        `inputs` is the flat list of the values of u, `kinetic` and `static` are those of the
        capacities: one value for a held entry, else one for each node. With `keep` an interval in
        which an event is possible has its courses. Raise ParameterError for a capacity that is
        negative or a static one below the kinetic one.
        """
        capacities = self.layout.in_force(signs, kinetic, static)
        v = self._values(state, inputs, capacities)
        interval = self.maps[signs].whole(v, capacities)
        if interval is not None:
            return interval
        forcing = Forcing(self.layout, inputs, kinetic, static)
        return _Motion(self, forcing, v[: len(state)], signs, keep).to_the_end()

    def friction_signs(
        self, state: Values, signs: Signs, inputs: Values, kinetic: Values, static: Values
    ) -> list[int]:
        """
        Return the signs of the friction torques in an interval without events, 0 for any.

        The arguments are those of `advance`. A torque of which the sign is sure has it throughout.
        """
        capacities = self.layout.in_force(signs, kinetic, static)
        return self.maps[signs].friction_signs(self._values(state, inputs, capacities))

    def _values(self, state: Values, inputs: Values, capacities: Values) -> np.ndarray:
        """Return the flat values v that the maps take."""
        try:
            return np.frombuffer(self._pack(*state, *inputs, *capacities))
        except struct.error as error:
            raise ParameterError(
                f'friction: the inputs {inputs} do not fit the interval: {error}'
            ) from error

    def courses(
        self, state: Values, signs: Signs, inputs: Values, kinetic: Values, static: Values
    ) -> Sequence[tuple[Course, float]]:
        """
        Return the courses of an interval in their order, and the part of a piece each lasts.

        The arguments are those of `advance`. Integrals of anything over the interval are computed
        from the polynomials of its courses, which end at nodes and events.
        """
        forcing = Forcing(self.layout, inputs, kinetic, static)
        return _Motion(self, forcing, np.array(state), signs, keep=True).to_the_end().courses


def _prepare_alike(integrators: Sequence[HybridIntegrator], signs: Signs) -> None:
    """Prepare a mode of integrators whose series are of one extent."""
    first = integrators[0]
    flow = ModeFlow(HeldElements.stack([each._held(signs) for each in integrators]), signs)
    interval_map = IntervalMap(flow, first.piece_s, first.layout)
    for place, each in enumerate(integrators):
        each.flows[signs] = flow.of_system(place)
        each.maps[signs] = interval_map.of_system(place)


class _Motion:
    """State, mode, events and friction work during an interval."""

    def __init__(
        self,
        integrator: HybridIntegrator,
        forcing: Forcing,
        state: np.ndarray,
        signs: Signs,
        keep: bool = False,
    ) -> None:
        self._integrator, self._forcing = integrator, forcing
        self._keep = keep
        self._courses: list[tuple[Course, float]] = []
        """Courses and the part of a piece each lasts; empty unless they are kept."""
        self._state, self._signs = state, signs
        self._events: list[Event] = []
        self._work = [0.0] * len(signs)

    def to_the_end(self) -> Interval:
        """Integrate to the end of the interval."""
        piece, pieces = 0, self._forcing.layout.pieces
        while piece < pieces:
            piece = self._pass_pieces(piece)
            if piece < pieces:
                self._through_events(piece)
                piece += 1
        flow = self._integrator.flows[self._signs]
        w = self._forcing.at(self._signs, pieces - 1, 1.0)[: flow.inputs]
        friction = flow.force.dot(np.concatenate((self._state, w)))
        return Interval(
            self._state.tolist(),
            self._signs,
            self._events,
            self._work,
            friction.tolist(),
            self._courses,
        )

    def _pass_pieces(self, first: int) -> int:
        """Integrate to the start of the next piece with an event; return its index."""
        layout, values = self._forcing.layout, self._forcing.values(self._signs)
        ends, slips, lasts = self._integrator.maps[self._signs].by_piece(
            np.concatenate((self._state, values[layout.shifts[first]]))
        )
        count = min(lasts, layout.pieces - first)
        if count:
            if self._keep:
                self._keep_pieces(first, [self._state, *ends[: count - 1]])
            self._state = ends[count - 1]
            nodes = values[layout.nodes[first : first + count + 1]]
            for place, element in enumerate(self._integrator.flows[self._signs].slipping):
                capacities = nodes[:, element - len(self._signs)]
                before, after = slips[:count, :, place].T
                self._work[element] += float(
                    before.dot(capacities[:-1]) + after.dot(capacities[1:])
                )
        return first + count

    def _keep_pieces(self, first: int, starts: Sequence[np.ndarray]) -> None:
        """Keep the courses of whole pieces from the states (n,) at their starts."""
        flow = self._integrator.flows[self._signs]
        for piece, start in enumerate(starts, first):
            course = flow.course(start, self._forcing.at(self._signs, piece, 0.0))
            self._courses.append((course, 1.0))

    def _through_events(self, piece: int) -> None:
        """Integrate to the end of a piece, from event to event."""
        done, piece_s = 0.0, self._integrator.piece_s
        orders: list[int] | None = None
        course = self._integrator.flows[self._signs].course(
            self._state, self._forcing.at(self._signs, piece, 0.0)
        )
        for _ in range(MOST_EVENTS):
            if not isfinite(course.states.sum()):
                raise DdctError(
                    'friction: a state, an input or a capacity is not finite or far too large'
                )
            part, guard = course.first_event(orders, 1.0 - done)
            for element, work in zip(course.flow.slipping, course.work(part), strict=True):
                self._work[element] += piece_s * work
            if self._keep:
                self._courses.append((course, part))
            self._state = course.at(part)
            done += part
            if guard is None:
                return
            before = course
            course, orders = choose_mode(
                self._integrator.system,
                self._integrator.flows,
                self._state,
                self._signs,
                before.flow.guarded[guard],
                partial(self._forcing.at, piece=piece, part=done),
            )
            self._note_change((piece + done) * piece_s, before, part, course)
        raise DdctError(
            f'friction: more than {MOST_EVENTS} events in {piece_s:g} s: '
            'look for values that are far too large'
        )

    def _note_change(self, time_s: float, before: Course, part: float, after: Course) -> None:
        """Set the mode after an event at `part` of the course before it, and append the events."""
        signs = after.flow.signs
        for i, (old, new) in enumerate(zip(self._signs, signs, strict=True)):
            if old != new:
                kind = 'lock' if new == 0 else 'release' if old == 0 else 'reverse'
                slope = before.slip_slope(i, part) if old else after.slip_slope(i, 0.0)
                self._events.append(Event(time_s, i, kind, slope / self._integrator.piece_s))
        self._signs = signs
