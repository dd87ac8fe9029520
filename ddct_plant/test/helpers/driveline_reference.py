# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Another integration of a random driveline: scipy's DOP853, with its own search for events."""

from collections.abc import Callable
from itertools import product
from typing import Any, NamedTuple

import numpy as np
import scipy
from random_drivelines import INTERVAL_S, INTERVALS, FrictionEvent, Motion, RandomDriveline

Signs = tuple[int, ...]
AHEAD_S = 1e-7
"""Time after an event at which a mode must hold, or half the rest of the interval."""
ORDERS = 12
"""Order of the series for that time; a torque may reach an element through several springs."""
ANGLE = 0.03
"""Angle by which the fastest undamped mode turns between two instants of the search."""
NOISE = 1e-12
"""Value of a guard that counts as zero, over its scale."""
GRAZE = 1e-9
"""Least value of a guard that is a graze, over its scale."""


class Mode:
    """
    Linear motion while each element sticks or slips: d[w, q]/dt and f as rows on [w, q, u, c].

    The torques of elements that stick are the multipliers of the constraint that slips stay.
    """

    def __init__(self, line: RandomDriveline, signs: Signs) -> None:
        self.signs = signs
        size, stuck = line.size, [i for i, sign in enumerate(signs) if sign == 0]
        resisted = line.springs.T @ np.diag(line.damping) @ line.springs + np.diag(line.viscous)
        given = np.hstack(
            [
                -resisted,
                -line.springs.T * line.stiffness,
                line.drive,
                -line.slips.T * np.array(signs, float),
            ]
        )
        held = line.slips[stuck]
        none = np.zeros((len(stuck), len(stuck)))
        balance = np.block([[np.diag(line.inertias), held.T], [held, none]])
        found = np.linalg.solve(
            balance, np.vstack([given, np.zeros((len(stuck), given.shape[1]))])
        )
        twists = np.zeros((len(line.springs), given.shape[1]))
        twists[:, :size] = line.springs
        self.rate = np.vstack([found[:size], twists])
        self.force = np.zeros((line.elements, given.shape[1]))
        self.force[:, -line.elements :] = np.diag(np.array(signs, float))
        self.force[stuck] = found[size:]
        self.guards, self.guarded = self._guards(line)

    def _guards(self, line: RandomDriveline) -> tuple[np.ndarray, list[int]]:
        """Return what is positive in this mode as rows on [w, q, u, c], and whose it is."""
        rows: list[np.ndarray] = []
        guarded: list[int] = []
        for i, sign in enumerate(self.signs):
            if sign:
                row = np.zeros(self.rate.shape[1])
                row[: line.size] = sign * line.slips[i]
                rows.append(row)
            else:
                limit = np.zeros(self.rate.shape[1])
                limit[i - line.elements] = line.ratio
                rows += [limit - self.force[i], limit + self.force[i]]
            guarded += [i] * (len(rows) - len(guarded))
        return np.array(rows), guarded


class Reference:
    """The motion of a random driveline, from event to event."""

    def __init__(self, line: RandomDriveline) -> None:
        self._line = line
        self._modes: dict[Signs, Mode] = {}
        self._state = np.concatenate([line.speeds, np.zeros(len(line.springs))])
        self._signs: Signs = tuple(int(s) for s in np.sign(line.slips @ line.speeds))
        self._spacing_s = min(ANGLE / line.fastest(), INTERVAL_S / 50)
        self._start_s = 0.0
        self._inputs, self._slopes = np.zeros(0), np.zeros(0)
        self.motion = Motion(peak=float(np.abs(line.speeds).max()))

    def run(self) -> Motion:
        """Integrate all intervals."""
        line = self._line
        for interval in range(INTERVALS):
            first, last = line.capacities[interval : interval + 2]
            torques = line.torques[interval]
            self._start_s = interval * INTERVAL_S
            self._inputs = np.concatenate([torques, first])
            self._slopes = np.concatenate([0.0 * torques, (last - first) / INTERVAL_S])
            self._interval()
            self.motion.speeds.append(self._state[: line.size].copy())
        return self.motion

    def _mode(self, signs: Signs) -> Mode:
        if signs not in self._modes:
            self._modes[signs] = Mode(self._line, signs)
        return self._modes[signs]

    def _all(self, time: Any, state: np.ndarray) -> np.ndarray:
        """Return [w, q, u, c] for a time in s of the interval, or each of several."""
        given = self._inputs + np.multiply.outer(time, self._slopes)
        return np.concatenate([state, given.T])

    def _interval(self) -> None:
        mode, now = self._mode(self._signs), 0.0
        margins = mode.guards @ self._all(0.0, self._state)
        wrong = [
            element
            for element, margin in zip(mode.guarded, margins, strict=True)
            if mode.signs[element] == 0 and margin < -NOISE * self._scale(element, mode)
        ]
        if wrong:
            self._change(now, wrong[0])
        while now < INTERVAL_S - 1e-15:
            now, element = self._to_next_event(now)
            if element is not None:
                self._change(now, element)

    def _to_next_event(self, start: float) -> tuple[float, int | None]:
        """Integrate to the next event, or the end; return the time and whose event it is."""
        mode = self._mode(self._signs)
        count = len(self._state)
        constant = mode.rate[:, count:] @ self._inputs
        rising = mode.rate[:, count:] @ self._slopes
        a = np.ascontiguousarray(mode.rate[:, :count])
        solution = scipy.integrate.solve_ivp(
            lambda time, state: a @ state + (constant + rising * time),
            (start, INTERVAL_S),
            self._state,
            'DOP853',
            dense_output=True,
            rtol=1e-13,
            atol=1e-14 * max(1.0, self.motion.peak),
        )
        times = self._times(start)
        states = solution.sol(times)
        values = mode.guards @ self._all(times, states)
        first, which = INTERVAL_S, None
        for guard, element in enumerate(mode.guarded):

            def value(time: float, row: np.ndarray = mode.guards[guard]) -> float:
                return float(row @ self._all(time, solution.sol(time)))

            at = self._first_zero(value, times, values[guard], self._scale(element, mode))
            if at is not None and at < first:
                first, which = at, element
        before = np.abs(states[: self._line.size, times <= first])
        self.motion.peak = max(self.motion.peak, float(before.max()))
        self._state = solution.y[:, -1] if which is None else solution.sol(first)
        return first, which

    def _times(self, start: float) -> np.ndarray:
        """Return instants to the end, close to each other just after the start."""
        steps = int(np.ceil((INTERVAL_S - start) / self._spacing_s)) + 1
        times = np.linspace(start, INTERVAL_S, steps + 1)
        early = start + self._ahead_s(start) * 2.0 ** np.arange(30)
        return np.concatenate([times[:1], early[early < times[1]], times[1:]])

    @staticmethod
    def _ahead_s(now: float) -> float:
        return min(AHEAD_S, 0.5 * (INTERVAL_S - now))

    def _scale(self, element: int, mode: Mode) -> float:
        """Return what a guard's rounding is relative to: the peak speed, or the capacities."""
        return max(1.0, self.motion.peak if mode.signs[element] else self._line.capacities.max())

    def _first_zero(
        self, value: Callable[[float], float], times: np.ndarray, values: np.ndarray, scale: float
    ) -> float | None:
        """Return where a guard first falls below zero, also for a moment between two instants."""
        below = np.flatnonzero(values[1:] < -NOISE * scale) + 1
        end = int(below[0]) if len(below) else len(times)
        inner = np.arange(1, min(end, len(times) - 1))
        before, now, after = values[inner - 1], values[inner], values[inner + 1]
        turns = (
            (now <= before) & (now <= after) & (now < before - 2.0 * now + after + GRAZE * scale)
        )
        for place in inner[turns]:
            low, high = times[place - 1], times[place + 1]
            least = scipy.optimize.minimize_scalar(
                value, bounds=(low, high), method='bounded', options={'xatol': 1e-12}
            )
            self.motion.grazes += int(abs(least.fun) < GRAZE * scale)
            if least.fun < -NOISE * scale:
                return self._zero(value, low, float(least.x))
        if not len(below):
            return None
        # It may have been zero, or below by rounding, since the start or a while before.
        last = int(np.flatnonzero(values[:end] > 0.0).max(initial=0))
        return self._zero(value, times[last], times[last + 1])

    @staticmethod
    def _zero(value: Callable[[float], float], low: float, high: float) -> float:
        if value(low) <= 0.0:
            return low
        return float(scipy.optimize.brentq(value, low, high, xtol=1e-16, rtol=1e-15))

    def _change(self, now: float, element: int) -> None:
        """Go over to the mode that holds just after an event of an element."""
        line, count = self._line, len(self._state)
        slips = line.slips @ self._state[: line.size]
        small = 1e-11 * max(1.0, self.motion.peak)
        free = [
            i
            for i, (sign, slip) in enumerate(zip(self._signs, slips, strict=True))
            if sign == 0 or i == element or abs(slip) < small
        ]
        rows = line.slips[free]
        spread = rows.T / line.inertias[:, None]
        self._state[: line.size] -= spread @ np.linalg.solve(
            rows @ spread, rows @ self._state[: line.size]
        )
        held = []
        for choice in product((0, 1, -1), repeat=len(free)):
            signs = list(self._signs)
            for i, sign in zip(free, choice, strict=True):
                signs[i] = sign
            if tuple(signs) != self._signs and self._holds(
                self._mode(tuple(signs)), free, now, count
            ):
                held.append(tuple(signs))
        # A static capacity above the kinetic one may leave several: the fewest slip.
        new = min(held, key=lambda signs: (sum(map(abs, signs)), signs[element] == 0))
        for i, (old, sign) in enumerate(zip(self._signs, new, strict=True)):
            if old != sign:
                kind = 'lock' if sign == 0 else 'release' if old == 0 else 'reverse'
                self.motion.events.append(FrictionEvent(self._start_s + now, i, kind))
        self._signs = new

    def _holds(self, mode: Mode, free: list[int], now: float, count: int) -> bool:
        """Return whether a mode of the elements without slip is right just after `now`."""
        everything = self._all(now, self._state)
        change = np.concatenate([0.0 * self._state, self._slopes])
        moved = np.zeros_like(everything)
        term, factor = change, 1.0
        rate = mode.rate @ everything
        for order in range(1, ORDERS):
            factor *= self._ahead_s(now) / order
            term = np.concatenate([rate, change[count:] if order == 1 else 0.0 * change[count:]])
            moved += factor * term
            rate = mode.rate @ term
        for row, element in zip(mode.guards, mode.guarded, strict=True):
            if element not in free:
                continue
            sticks = mode.signs[element] == 0
            value = row @ moved + (row @ everything if sticks else 0.0)
            if value < (-1e-13 * self._scale(element, mode) if sticks else 0.0):
                return False
            if not sticks and value == 0.0:
                return False
        return True


class Comparison(NamedTuple):
    """A driveline by the hybrid integrator beside the reference."""

    apart: bool
    """Whether it has a graze, or events within 1e-6 s of each other."""
    events: int
    """Number of events of the reference."""
    same_order: bool
    """Whether the events are the same, in the same order."""
    instants_s: float
    """Largest difference of the instants in s, where the order is the same."""
    speeds: float
    """Largest difference of the speeds at the ends of intervals, over the peak."""

    @property
    def agrees(self) -> bool:
        """Whether the order is the same, instants within 1e-7 s and speeds within 1e-8."""
        return self.same_order and self.instants_s <= 1e-7 and self.speeds <= 1e-8


def compared(index: int) -> Comparison:
    """Return the comparison of the random driveline of an index."""
    line = RandomDriveline(index)
    ours, other = line.integrated(), Reference(line).run()
    same = [event[1:] for event in ours.events] == [event[1:] for event in other.events]
    instants = (abs(a.time_s - b.time_s) for a, b in zip(ours.events, other.events, strict=False))
    speeds = np.abs(np.array(ours.speeds) - np.array(other.speeds)).max()
    return Comparison(
        apart=other.grazes > 0 or any(m.events_closer_than(1e-6) for m in (ours, other)),
        events=len(other.events),
        same_order=same,
        instants_s=max(instants, default=0.0) if same else np.inf,
        speeds=float(speeds) / other.peak,
    )
