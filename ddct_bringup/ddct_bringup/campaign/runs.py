# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The runs of a campaign by index: settings of each, and a check that all can be built."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.campaign.draws import run_seed, uniform
from ddct_bringup.campaign.keys import COMMON, CONTROLLERS, FILE_KEY, SCENARIO
from ddct_bringup.campaign.rows import RunBase, require_suitable
from ddct_bringup.campaign.spec import MOST_RUNS, CampaignSpec
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import located
from ddct_plant.scenario.file import is_packaged
from ddct_plant.scenario.settings import RunSettings

_CSV = 'csv'


@dataclass(frozen=True)
class CampaignRun:
    """One run, which becomes one row."""

    index: int
    controller: ControllerSpec[Controller]
    varied: Mapping[str, Any]
    """Values by key, as the specification gives them."""
    settings: RunSettings


class Campaign:
    """
    The runs that a specification describes.

    A case is a point of the grid with one sample. All controllers have the same cases, noise
    included. The runs of the first controller have the first indices, then follow those of the
    next.
    """

    def __init__(self, spec: CampaignSpec) -> None:
        """Read the files that the specification names; raise DdctError for a missing one."""
        self.spec = spec
        points = prod(len(values) for values in spec.grid.values())
        self.cases = points * spec.samples
        """Number of runs of each controller."""
        self._names = [
            str(spec.folder / each) if is_controller_file(each) else each
            for each in spec.controllers
        ]
        self.controllers = [controller_spec(each) for each in self._names]
        self.labels = [each.name for each in self.controllers]
        """Names of the controllers in results."""
        for label in self.labels:
            if self.labels.count(label) > 1:
                raise ParameterError(f'{CONTROLLERS}: two are called {label}: rename one')
        self.runs = self.cases * len(self.controllers)
        """Number of runs."""
        if self.runs > MOST_RUNS:
            raise ParameterError(f'{self.runs} runs: give at most {MOST_RUNS}')
        varied = SCENARIO in spec.keys
        scenarios = spec.values_of(SCENARIO) if varied else (spec.common[SCENARIO],)
        self._bases = {
            name: RunBase(spec.scenario_file(name), {}, {}, self.labels) for name in scenarios
        }

    def run(self, index: int) -> CampaignRun:
        """Return a run; raise ParameterError with its index where its scenario is invalid."""
        number, case = divmod(index, self.cases)
        varied = self.varied(case)
        given = {'seed': run_seed(self.spec.root, case), **self.spec.common, **varied}
        base = self._bases[given.pop(SCENARIO)]
        with located(_name(index, varied)):
            settings = base.at({key: self._placed(key, value) for key, value in given.items()})
        return CampaignRun(index, self.controllers[number], varied, settings)

    def chosen(self, index: int) -> str:
        """Return the name of a run's controller, or the path of its file."""
        return self._names[index // self.cases]

    def varied(self, case: int) -> dict[str, Any]:
        """Return the values of a case by key; the last key of the grid changes fastest."""
        grid = self.spec.grid
        shape = [len(values) for values in grid.values()]
        places = np.unravel_index(case // self.spec.samples, shape)
        drawn = {
            key: distribution.value(uniform(self.spec.root, key, case))
            for key, distribution in self.spec.vary.items()
        }
        return {key: grid[key][place] for key, place in zip(grid, places, strict=True)} | drawn

    def plan(self) -> Iterator[int]:
        """
        Build the settings of every run, and each controller in the first run of each kind.

        Yield the number of cases that are done. Raise ParameterError with the first invalid run.
        """
        known: set[tuple[str, ...]] = set()
        for case in range(self.cases):
            run = self.run(case)
            kind = tuple(run.varied.get(key, '') for key in COMMON)
            if kind not in known:
                known.add(kind)
                for number, controller in enumerate(self.controllers):
                    with located(_name(number * self.cases + case, run.varied)):
                        require_suitable(controller, run.settings)
            yield case + 1

    def digest(self) -> str:
        """Return a hash of the specification and of the files that it names."""
        digest = hashlib.sha256(self.spec.text().encode())
        for path in self._named_files():
            try:
                digest.update(hashlib.sha256(path.read_bytes()).digest())
            except OSError as error:
                raise DdctError(f'{path}: cannot be read ({error.strerror})') from error
        for controller in self.controllers:
            digest.update(repr(sorted(controller.digests.items())).encode())
        return digest.hexdigest()

    def _named_files(self) -> Iterator[Path]:
        """Yield the scenarios and profiles that are files of the user."""
        for file in (base.file for base in self._bases.values()):
            if not is_packaged(file.name):
                yield Path(file.name)
            for section in file.content.values():
                if isinstance(section, Mapping) and _CSV in section:
                    yield Path(file.name).parent / section[_CSV]
        for key in self.spec.keys:
            for value in self.spec.values_of(key):
                placed = self._placed(key, value)
                if key.endswith(FILE_KEY):
                    yield Path(placed)
                elif isinstance(placed, Mapping) and _CSV in placed:
                    yield Path(placed[_CSV])

    def _placed(self, key: str, value: Any) -> Any:
        """Return a value; if it names a file, with the folder in front."""
        if key.endswith(FILE_KEY) and isinstance(value, str):
            return str(self.spec.folder / value)
        if isinstance(value, Mapping) and isinstance(value.get(_CSV), str):
            return {**value, _CSV: str(self.spec.folder / value[_CSV])}
        return value


def _name(index: int, varied: Mapping[str, Any]) -> str:
    """Return the name of a run in error messages."""
    values = ', '.join(f'{key} {value}' for key, value in varied.items())
    return f'run {index} ({values})'
