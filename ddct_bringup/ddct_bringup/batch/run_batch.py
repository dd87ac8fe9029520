# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Compute many runs at once.

    from ddct_bringup.batch.run_batch import run_batch
    results = run_batch([(settings, controller), ...], limits)

A result equals that of the run step by step to 1e-9 of each value, and does not depend on which
other runs are in the batch. A run in which rounding grows beyond that has no result.
"""

from collections import defaultdict
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.batchable import kind_of
from ddct_bringup.batch.results import part_of_stack, stacked_results, until
from ddct_bringup.batch.simulate import Stack, loop_kind, simulate_batch
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.validity import are_signals
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.interface import Controller
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import RunSettings

MOST_RUNS = 1000
"""Largest number of runs at once: their matrices of a step fit the processor's cache."""
MOST_CARS = 250
"""Largest number of drivelines with plates that stick at once: each takes half a megabyte."""
_FEWEST_SWITCHES = 5
"""Fewest saturation switches that trigger the rounding test."""
_FEWEST_REVERSALS = 20
"""Fewest reversals of the request that do so."""
_REVERSED_SHARE = 0.1
"""Smallest change in a period that counts as one, over the largest request."""
_FEEDBACK_FACTOR = 1.0 + 2.0**-46
"""Factor on the feedback in the rounding test, several times the rounding error."""
_SLIP_TOLERANCE = 1e-10
"""Largest change of the slip in the rounding test, relative to the largest slip."""
Run = tuple[RunSettings, Controller]


def run_batch(runs: Sequence[Run], limits: Limits) -> list[ScoredRun | None]:
    """
    Return the result of each run as `stacked_results`, in order.

    The runs are those for which `why_not_batchable` is empty.
    A controller may occur in many runs; each starts with it as it is after a reset. A result is
    None for a run that must be computed step by step: a divergent run or one that cannot be built
    gets its reason there, and a chaotic one gets repeatable metrics.
    """
    results: list[ScoredRun | None] = [None] * len(runs)
    for chunk in _chunks(runs):
        found = _results([runs[index] for index in chunk], limits)
        for index, result in zip(chunk, found, strict=True):
            results[index] = result
    return results


def _chunks(runs: Sequence[Run]) -> list[list[int]]:
    """Return the indices of the runs that are computed together, chunk by chunk."""
    groups: dict[Hashable, list[int]] = defaultdict(list)
    for index, (settings, _) in enumerate(runs):
        groups[loop_kind(settings)].append(index)
    return [chunk for group in groups.values() for chunk in _parts(runs, group)]


def _parts(runs: Sequence[Run], group: Sequence[int]) -> Iterator[list[int]]:
    """Yield the indices of a group in parts of at most MOST_RUNS runs and MOST_CARS cars."""
    part: list[int] = []
    cars: set[Hashable] = set()
    for index in group:
        settings = runs[index][0]
        if settings.stick_slip:  # such cars have a map of each of their modes
            cars.add(_car(settings))
        if len(part) == MOST_RUNS or len(cars) > MOST_CARS:
            yield part
            part, cars = [], {_car(settings)}
        part.append(index)
    yield part


def _car(settings: RunSettings) -> Hashable:
    """Return the driveline of a run, in a shift with both gears."""
    scenario = settings.scenario
    return gears_of(scenario) if settings.shift else scenario.driveline


def _results(runs: Sequence[Run], limits: Limits) -> list[ScoredRun | None]:
    try:
        with np.errstate(all='ignore'):  # what is not finite has no result
            settings, controllers = zip(*runs, strict=True)
            stack = simulate_batch(settings, controllers)
            results: list[ScoredRun | None] = [None] * len(runs)
            for length, found in _alike(settings, stack):
                for index, result in _of_length(runs, stack, length, found, limits):
                    results[index] = result
    except FOREIGN_FAILURES:  # also of a user's controller, whose reason the run alone gives
        if len(runs) == 1:
            return [None]
        half = len(runs) // 2
        return _results(runs[:half], limits) + _results(runs[half:], limits)
    return results


def _alike(settings: Sequence[RunSettings], stack: Stack) -> Iterator[tuple[int, np.ndarray]]:
    """Yield the last step and the indices of runs that are judged alike, without unsure ones."""
    groups: dict[tuple[Any, ...], list[int]] = defaultdict(list)
    for index in np.flatnonzero(~stack.unsure).tolist():
        scenario = settings[index].scenario
        start = scenario.control_start_step
        key = int(stack.last[index]), scenario.steps, start, scenario.score_window_s
        groups[key].append(index)
    for (length, *_), group in groups.items():
        yield length, np.array(group)


def _of_length(
    runs: Sequence[Run], stack: Stack, length: int, found: np.ndarray, limits: Limits
) -> Iterator[tuple[int, ScoredRun]]:
    """Yield index and result of those of some runs that are repeatable; they end with a step."""
    whole = len(found) == len(runs)
    part = until(stack.trajectory if whole else part_of_stack(stack.trajectory, found), length)
    counts = _usable(part) & _repeatable([runs[index] for index in found.tolist()], part)
    found = found[counts]
    if found.size:
        settings = [runs[index][0] for index in found.tolist()]
        kept = part if counts.all() else part_of_stack(part, counts)
        results = stacked_results(settings, kept, limits)
        for index, result in zip(found.tolist(), results, strict=True):
            fallbacks = kind_of(runs[index][1]).fallbacks if stack.fed[index] else None
            yield index, replace(result, fallbacks=fallbacks)


def _repeatable(runs: Sequence[Run], stack: Trajectory) -> np.ndarray:
    """
    Return for each run of a stack whether its rounding errors stay small, (R,).

    Feedback that is too strong for its loop oscillates across the saturation at zero torque, or
    between its own limits: each pass may amplify a difference, until the metrics are those of
    another run.
    """
    cut = stack.torque_request < 0.0
    switches = np.count_nonzero(np.diff(cut, axis=-1), axis=-1)
    reversals = _reversals(np.maximum(stack.torque_request, 0.0))
    suspects = np.flatnonzero((switches >= _FEWEST_SWITCHES) | (reversals >= _FEWEST_REVERSALS))
    repeatable = np.ones(len(runs), dtype=bool)
    if len(suspects):
        settings, controllers = zip(*[runs[index] for index in suspects.tolist()], strict=True)
        slip = stack.slip_speed[suspects]
        found = simulate_batch(settings, controllers, _FEEDBACK_FACTOR)
        again = found.trajectory.slip_speed
        again = again[:, : slip.shape[-1]]
        difference = np.max(np.abs(again - slip), axis=-1)
        repeatable[suspects] = difference <= _SLIP_TOLERANCE * np.max(np.abs(slip), axis=-1)
    return repeatable


def _reversals(request: np.ndarray) -> np.ndarray:
    """Return how often large changes of the requests, (R, N+1) in N m, change their sign, (R,)."""
    change = np.diff(request, axis=-1)
    large = np.abs(change) > _REVERSED_SHARE * np.max(request, axis=-1, keepdims=True)
    steps = np.arange(change.shape[-1])
    latest = np.maximum.accumulate(np.where(large, steps, 0), axis=-1)
    rises = np.take_along_axis(large & (change > 0.0), latest, axis=-1)
    known = np.logical_or.accumulate(large, axis=-1)
    return np.count_nonzero((rises[:, 1:] != rises[:, :-1]) & known[:, :-1], axis=-1)


def _usable(stack: Trajectory) -> np.ndarray:
    """Return for each run of a stack whether all its values are those of signals, (R,)."""
    each = [
        are_signals(values).all(axis=tuple(range(1, values.ndim)))
        for values in stack.signals.values()
        if values.dtype != object
    ]
    return np.all(each, axis=0)
