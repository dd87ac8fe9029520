# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Slip references of many runs with their previews."""

from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.nominal_slips import nominal_slips
from ddct_bringup.batch.stacks import distinct, rows_of
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.control import ENGINE_SPEED_TARGET, PROFILE
from ddct_plant.scenario.settings import KnownSettings
from ddct_reference.descent import Descent
from ddct_reference.factory import make_descent, nominal_settings

_RAMP = 'ramp'
Points = tuple[np.ndarray, np.ndarray]
"""References in rad/s and their rates in rad/s^2."""


def why_no_reference(settings: KnownSettings) -> str:
    """Return in one line why the reference of a run is not among `References`, else empty."""
    if settings.reference_shape == ENGINE_SPEED_TARGET:
        return f'reference.shape is {ENGINE_SPEED_TARGET}'
    return ''


def _reference_kind(settings: KnownSettings) -> Hashable:
    nominal = None if settings.detailed else nominal_settings(settings.scenario).stick_slip
    return descent_kind(settings), settings.scenario.control_start_step, nominal


def descent_kind(settings: KnownSettings) -> str:
    """Return what runs with common `Descents` share besides their control start."""
    shape = settings.reference_shape
    return shape if shape in (_RAMP, PROFILE) else 'timed'


class References:
    """Slip references of R runs of several kinds, those of one kind together."""

    def __init__(self, runs: Sequence[KnownSettings], preview_steps: int, steps: int) -> None:
        """Compute everything that does not depend on the slip, up to step `steps`."""
        places: dict[Hashable, list[int]] = defaultdict(list)
        for place, run in enumerate(runs):
            places[_reference_kind(run)].append(place)
        self._parts = [
            (
                rows_of(of_kind),
                _ReferencesOfOneKind([runs[each] for each in of_kind], preview_steps, steps),
            )
            for of_kind in places.values()
        ]
        self._shape = len(runs), preview_steps + 1

    def update(self, step: int, slip_speed: np.ndarray, share: Any = 1.0) -> Points:
        """
        Return references and rates at steps k, k + 1, ..., k + P, (R, P + 1), for w_d, (R,).

        The units are rad/s and rad/s^2. `share` is that of a shift, here 1.
        """
        if len(self._parts) == 1:
            return self._parts[0][1].update(step, slip_speed)
        speeds, rates = np.empty((2, *self._shape))
        for rows, part in self._parts:
            speeds[rows], rates[rows] = part.update(step, slip_speed[rows])
        return speeds, rates


class _ReferencesOfOneKind:
    """Slip references of R runs of one kind, the counterpart of `DescendingReference`."""

    def __init__(self, runs: Sequence[KnownSettings], preview_steps: int, steps: int) -> None:
        """Compute everything that does not depend on the slip, up to step `steps`."""
        self._start = runs[0].scenario.control_start_step
        self._points = preview_steps + 1
        self._stored = None if runs[0].detailed else nominal_slips(runs, self._start)
        self._start_value = np.zeros(len(runs)) if self._stored is None else self._stored[:, -1]
        self._descents = make_descents(runs, preview_steps, steps)

    def update(self, step: int, slip_speed: np.ndarray) -> Points:
        """Return references and rates as `References` does."""
        if self._stored is None and step <= self._start:
            self._start_value = slip_speed
        waiting = min(max(self._start - step, 0), self._points)
        first = step + waiting - self._start
        if not waiting:
            return self._descents.at(self._start_value, first, self._points)
        before = self._before(step, waiting)
        if waiting == self._points:
            return before
        after = self._descents.at(self._start_value, first, self._points - waiting)
        speeds, rates = (
            np.concatenate(parts, axis=1) for parts in zip(before, after, strict=True)
        )
        return speeds, rates

    def _before(self, step: int, count: int) -> Points:
        """Return the points at steps k, k + 1, ... before control start."""
        if self._stored is None:
            speeds = np.repeat(self._start_value[:, np.newaxis], count, axis=1)
            return speeds, np.zeros_like(speeds)
        values = self._stored[:, step : step + count + 1]
        return values[:, :-1], np.diff(values) / PERIOD_S


class Descents(ABC):
    """Descents of R runs from control start on, the counterpart of `Descent`."""

    @abstractmethod
    def __init__(self, runs: Sequence[KnownSettings], periods: np.ndarray) -> None:
        """Compute what does not depend on the start, at whole periods 0, 1, ... after it."""

    @abstractmethod
    def at(self, start: np.ndarray, first: int | np.ndarray, count: int) -> Points:
        """
        Return the points of `count` periods from `first` on, (R, count), for starts (R,).

        `first` is one period, or that of each run, (R,).
        """


def make_descents(runs: Sequence[KnownSettings], preview_steps: int, steps: int) -> Descents:
    """Return the descents of runs of one kind, for references up to step `steps`."""
    periods = np.arange(max(steps - runs[0].scenario.control_start_step + 1, 0) + preview_steps)
    kinds: dict[str, type[Descents]] = {_RAMP: _Ramps, PROFILE: _Profiles}
    return kinds.get(descent_kind(runs[0]), _Timed)(runs, periods)


def _of_periods(table: np.ndarray, first: int | np.ndarray, count: int) -> np.ndarray:
    """Return the values of `count` periods from `first` on, (R, count), of all, (R, n)."""
    if isinstance(first, int):
        return table[:, first : first + count]
    return np.take_along_axis(table, first[:, np.newaxis] + np.arange(count), axis=1)


class _Ramps(Descents):
    """The counterpart of `CrfRamp`."""

    def __init__(self, runs: Sequence[KnownSettings], periods: np.ndarray) -> None:
        slopes = [run.scenario.reference.slope_rad_s2 for run in runs]
        self._slope = np.array(slopes)[:, np.newaxis]
        self._times = np.broadcast_to(periods * PERIOD_S, (len(runs), len(periods)))

    def at(self, start: np.ndarray, first: int | np.ndarray, count: int) -> Points:
        start = start[:, np.newaxis]
        size = np.abs(start) - self._slope * _of_periods(self._times, first, count)
        ended = size <= 0.0
        rates = -np.copysign(self._slope, start)
        return np.where(ended, 0.0, np.copysign(size, start)), np.where(ended, 0.0, rates)


class _Profiles(Descents):
    """The counterpart of `ProfileDescent`."""

    def __init__(self, runs: Sequence[KnownSettings], periods: np.ndarray) -> None:
        times = runs[0].scenario.control_start_s + periods * PERIOD_S
        profiles = [run.scenario.slip_reference for run in runs]
        self._values = np.stack([each.over(times) for each in profiles])
        following = np.stack([each.over(times + PERIOD_S) for each in profiles])
        self._rates = (following - self._values) / PERIOD_S

    def at(self, start: np.ndarray, first: int | np.ndarray, count: int) -> Points:
        values, rates = self._values, self._rates
        return _of_periods(values, first, count), _of_periods(rates, first, count)


class _Timed(Descents):
    """The counterpart of `TimedDescent`."""

    def __init__(self, runs: Sequence[KnownSettings], periods: np.ndarray) -> None:
        firsts, places = distinct((run.reference_shape, run.scenario.reference) for run in runs)
        found = np.array([_course(make_descent(runs[index]), periods) for index in firsts])
        self._shares, self._rates = found[places].transpose(2, 0, 1)

    def at(self, start: np.ndarray, first: int | np.ndarray, count: int) -> Points:
        start = start[:, np.newaxis]
        shares, rates = self._shares, self._rates
        return start * _of_periods(shares, first, count), start * _of_periods(rates, first, count)


def _course(descent: Descent, periods: np.ndarray) -> list[tuple[float, float]]:
    """Return the remaining share of the start and its rate, for each period."""
    return [descent.at(1.0, since * PERIOD_S) for since in periods.tolist()]
