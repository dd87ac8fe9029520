"""The motion from event to event."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.hybrid.forcing import Forcing
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.mode_choice import choose_mode
from ddct_plant.hybrid.mode_flow import ModeFlow, Signs
from ddct_plant.hybrid.polynomials import first_negative, on_interval

MOST_EVENTS = 1000
"""In one piece; a motion with more is not one of dry friction between inertias."""


@dataclass(frozen=True, slots=True)
class Event:
    """An element locks, is released, or changes the direction of its slip."""

    time_s: float
    """From the start of the interval."""
    element: int
    kind: str
    """`lock`, `release` or `reverse`."""


class Motion:
    """State, mode, events and friction work as they come about in an interval with events."""

    def __init__(
        self,
        system: FrictionSystem,
        flows: Mapping[Signs, ModeFlow],
        piece_s: float,
        forcing: Forcing,
        state: np.ndarray,
        signs: Signs,
    ) -> None:
        self._system, self._flows, self._piece_s = system, flows, piece_s
        self._forcing = forcing
        self.state, self.signs = state, signs
        self.events: list[Event] = []
        self.work = [0.0] * system.elements

    def friction(self) -> list[float]:
        """Return the friction torques (N,) at the end of the interval."""
        flow = self._flows[self.signs]
        w = self._forcing.at(self.signs, -1, 1.0)[: flow.inputs]
        return flow.force.dot(np.concatenate((self.state, w))).tolist()

    def pass_piece(self, piece: int) -> None:
        """Go on to the end of a piece."""
        flow = self._flows[self.signs]
        forcing = self._forcing.pieces(self.signs)[piece]
        ends, slips, guards = flow.over_a_piece(np.concatenate((self.state, forcing)))
        if guards[guards.argmin()] >= 0.0:
            self._add_work(slips.tolist(), forcing, 1.0)
            self.state = ends
        else:
            self._through_events(piece)

    def _through_events(self, piece: int) -> None:
        """Go on to the end of a piece from event to event."""
        done = 0.0
        orders: np.ndarray | None = None
        for _ in range(MOST_EVENTS):
            flow = self._flows[self.signs]
            forcing = self._forcing.at(self.signs, piece, done)
            states, guards = flow.polynomials(np.concatenate((self.state, forcing)))
            if not np.isfinite(states).all():
                raise DdctError(
                    'friction: a state, an input or a capacity is not finite or far too large'
                )
            if orders is not None:
                guards[flow.powers < orders[:, None]] = 0.0
            part, guard = _first_event(guards, orders, 1.0 - done)
            self._add_work(flow.slip_integrals(on_interval(guards, part)), forcing, part)
            self.state = (part**flow.powers).dot(states)
            done += part
            if guard is None:
                return
            orders = self._change_mode(piece, done, flow.guarded[guard])
        raise DdctError(
            f'friction: more than {MOST_EVENTS} events in {self._piece_s:g} s: '
            'look for values that are far too large'
        )

    def _add_work(self, slips: list[float], forcing: np.ndarray, part: float) -> None:
        """Add slip times capacity over a part of a piece; for `slips` see `slip_integrals`."""
        inputs, elements = len(forcing) // 2, len(self.signs)
        capacities = forcing[inputs - elements : inputs].tolist()
        changes = forcing[-elements:].tolist()
        for place, element in enumerate(self._flows[self.signs].slipping):
            before, after = slips[2 * place : 2 * place + 2]
            work = (before + after) * capacities[element] + after * part * changes[element]
            self.work[element] += part * self._piece_s * work

    def _change_mode(self, piece: int, done: float, element: int) -> np.ndarray:
        """Choose the mode that goes on, note what changes, return the orders of its guards."""
        before = self.signs
        self.state, self.signs, orders = choose_mode(
            self._system,
            self._flows,
            self.state,
            before,
            element,
            lambda flow: self._forcing.at(flow.signs, piece, done),
        )
        time_s = (piece + done) * self._piece_s
        for i, (old, new) in enumerate(zip(before, self.signs, strict=True)):
            if old != new:
                kind = 'lock' if new == 0 else 'release' if old == 0 else 'reverse'
                self.events.append(Event(time_s, i, kind))
        return orders


def _first_event(
    guards: np.ndarray, orders: np.ndarray | None, end: float
) -> tuple[float, int | None]:
    """
    Return when within [0, end] the first guard turns negative, and which; or `end` and None.

    A guard of order k is zero at 0 with k - 1 derivatives, so that its next root is that of the
    guard divided by t^k.
    """
    first, which = end, None
    suspects = np.flatnonzero(on_interval(guards, end).min(axis=1) < 0.0)
    for guard in suspects.tolist():
        order = 0 if orders is None else int(orders[guard])
        at = first_negative(guards[guard, order:], end)
        if at is not None and (which is None or at < first):
            first, which = at, guard
    return first, which
