# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A set of runs by index: every controller in every case, where a case is a point with samples."""

import copy
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import groupby
from math import prod
from typing import Any, Self

import numpy as np

from ddct_bringup.campaign.draws import Draw, drawn_in_part, run_seeds, uniforms
from ddct_bringup.campaign.keys import COMMON
from ddct_bringup.campaign.rows import SEED, require_suitable
from ddct_bringup.campaign.specification.distributions import Distribution
from ddct_bringup.run.run_base import RunBase
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import located
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.settings import RunSettings

MOST_CHECKED = 1000
"""Largest number of cases that are built before the first run starts."""


@dataclass(frozen=True)
class PlannedRow:
    """A run of the set with its settings, before it is computed; it becomes one row."""

    index: int
    controller: ControllerSpec[Controller]
    varied: Mapping[str, Any]
    """Values by key, as they were given."""
    settings: RunSettings

    @property
    def seed(self) -> int:
        """Seed of the random numbers within the run."""
        return self.settings.case.seed


@dataclass(frozen=True)
class ImpossibleRow:
    """A run of the set whose settings cannot be built; it becomes a row with the reason."""

    index: int
    controller: ControllerSpec[Controller]
    varied: Mapping[str, Any]
    seed: int
    error: DdctError
    """Reason, which names the run."""


@dataclass(eq=False)
class RunSet:
    """
    Runs of every controller in every case.

    A case is a point of the grid with one sample. All controllers have the same cases, noise
    included. The runs of the first controller have the first indices, then follow those of the
    next. A run is built when it is computed, and by its index alone.
    """

    controllers: Sequence[ControllerSpec[Controller]]
    bases: Mapping[Choice, RunBase]
    """Common settings of the runs, by the scenario's name."""
    common: Mapping[str, Any]
    """Values for all runs; its scenario, car and drive are a key of `bases`."""
    grid: Mapping[str, Sequence[Any]]
    """Values on the grid by key; the last key changes fastest."""
    samples: int = 1
    """Number of samples at each point of the grid."""
    of: int | None = None
    """Number of samples of the campaign whose first ones these are; None for this one."""
    vary: Mapping[str, Distribution] = field(default_factory=dict)
    """Distributions of the keys that are drawn in each sample, by key."""
    known: Sequence[str] = ()
    """Varied keys that controllers learn, besides those that they know in any run."""
    root: int | None = None
    """Root of the random numbers, and of the seed of each case; None where all have one seed."""

    @cached_property
    def cases(self) -> int:
        """Number of runs of each controller."""
        return prod(len(values) for values in self.grid.values()) * self.samples

    @property
    def runs(self) -> int:
        """Number of runs."""
        return self.cases * len(self.controllers)

    @cached_property
    def labels(self) -> list[str]:
        """Names of the controllers in results."""
        return [each.name for each in self.controllers]

    def run(self, index: int) -> PlannedRow:
        """Return a run; raise ParameterError with its index where its settings are invalid."""
        (run,) = self.planned(index, index + 1)
        if isinstance(run, ImpossibleRow):
            raise run.error
        return run

    def planned(self, first: int, last: int) -> Iterator[PlannedRow | ImpossibleRow]:
        """Yield the runs from the index `first` to `last`, `last` excluded."""
        while first < last:
            number, case = divmod(first, self.cases)
            end = min(last, (number + 1) * self.cases)
            cases = range(case, case + end - first)
            seeds = [] if self.root is None else self._drawn(partial(run_seeds, self.root), cases)
            for place, varied in enumerate(self.varied(cases)):
                given = {**self.common, **varied}
                if seeds:
                    given.setdefault(SEED, seeds[place])
                yield self._planned(first + place, self.controllers[number], varied, given)
            first = end

    def planned_at(self, indices: Sequence[int]) -> Iterator[PlannedRow | ImpossibleRow]:
        """Yield runs by their indices, which ascend."""
        for _, group in groupby(enumerate(indices), lambda each: each[1] - each[0]):
            successive = [index for _, index in group]
            yield from self.planned(successive[0], successive[-1] + 1)

    def _drawn(self, draw: Callable[[range], list[Draw]], cases: range) -> list[Draw]:
        """Return the random numbers of successive cases, from those of the whole campaign."""
        left_out = (self.of or self.samples) - self.samples
        return drawn_in_part(draw, cases, self.samples, left_out)

    def _planned(
        self,
        index: int,
        controller: ControllerSpec[Controller],
        varied: Mapping[str, Any],
        given: dict[str, Any],
    ) -> PlannedRow | ImpossibleRow:
        base = self.bases[Choice.taken_from(given)]
        try:
            settings = base.at(
                {key: self.placed(key, given[key]) for key in given},
                drawn=self.vary,
                known=self.known,
            )
        except DdctError as error:
            named = error.at(_name(index, varied))
            return ImpossibleRow(index, controller, varied, given.get(SEED, 0), named)
        return PlannedRow(index, controller, varied, settings)

    def with_common(self, values: Mapping[str, Any]) -> Self:
        """Return the same runs with further values for all of them, by key."""
        again = copy.copy(self)
        again.common = {**self.common, **values}
        return again

    def placed(self, key: str, value: Any) -> Any:
        """Return a value; if it names a file, its path."""
        return value

    def varied(self, cases: range) -> Sequence[Mapping[str, Any]]:
        """Return the values of some cases by key."""
        shape = [len(values) for values in self.grid.values()]
        points = np.array(cases) // self.samples
        places = np.unravel_index(points, shape) if shape else ()
        columns: dict[str, Sequence[Any]] = {
            key: [values[place] for place in of_key.tolist()]
            for (key, values), of_key in zip(self.grid.items(), places, strict=True)
        }
        if self.root is not None:
            columns |= {
                key: [
                    distribution.value(each)
                    for each in self._drawn(partial(uniforms, self.root, key), cases)
                ]
                for key, distribution in self.vary.items()
            }
        return [
            dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)
        ]

    def require_sound(self) -> None:
        """
        Build the settings of some cases, and each controller in the first one of each kind.

        These are all cases, or `MOST_CHECKED` at equal distances with the first and the last:
        the time until the first run does not grow with the number of runs. Raise DdctError with
        the first invalid run.
        """
        known: set[tuple[str, ...]] = set()
        for case in checked_cases(self.cases):
            run = self.run(case)
            kind = tuple(str(run.varied.get(key, '')) for key in COMMON)
            if kind not in known:
                known.add(kind)
                for number, controller in enumerate(self.controllers):
                    with located(_name(number * self.cases + case, run.varied)):
                        require_suitable(controller, run.settings)


def checked_cases(cases: int) -> list[int]:
    """Return the cases that are built before the first run starts."""
    if cases <= MOST_CHECKED:
        return list(range(cases))
    return [place * (cases - 1) // (MOST_CHECKED - 1) for place in range(MOST_CHECKED)]


def _name(index: int, varied: Mapping[str, Any]) -> str:
    """Return the name of a run in error messages."""
    values = ', '.join(f'{key} {value}' for key, value in varied.items())
    return f'run {index} ({values})'
