# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The runs of a campaign, from its specification, and the digest of all that they depend on."""

import hashlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.keys import CONTROLLERS, FILE_KEY, SCENARIO
from ddct_bringup.campaign.run_set import RunSet
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign.specification.parts import MOST_RUNS
from ddct_bringup.run.run_base import RunBase
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import is_packaged

_CSV = 'csv'


class Campaign(RunSet):
    """The runs that a specification describes, and a digest of what they depend on."""

    def __init__(self, spec: CampaignSpec) -> None:
        """Read the files that the specification names; raise DdctError for a missing one."""
        self.spec = spec
        self._names = [
            str(spec.folder / each) if is_controller_file(each) else each
            for each in spec.controllers
        ]
        controllers = [controller_spec(each) for each in self._names]
        labels = [each.name for each in controllers]
        for label in labels:
            if labels.count(label) > 1:
                raise ParameterError(
                    f'{CONTROLLERS}: two are called {label}: rename one', key=CONTROLLERS
                )
        varied = SCENARIO in spec.keys
        scenarios = spec.values_of(SCENARIO) if varied else (spec.common[SCENARIO],)
        super().__init__(
            controllers=controllers,
            bases={name: RunBase(spec.scenario_file(name), {}, {}, labels) for name in scenarios},
            common=spec.common,
            grid=spec.grid,
            samples=spec.samples,
            of=spec.of,
            floor_samples=spec.floor_samples,
            vary=spec.vary,
            root=spec.root,
        )
        if self.runs > MOST_RUNS:
            raise ParameterError(f'{self.runs} runs: give at most {MOST_RUNS}', key='runs')

    def chosen(self, index: int) -> str:
        """Return the name of a run's controller, or the path of its file."""
        return self._names[index // self.cases]

    def digest(self) -> str:
        """Return a hash of the specification and of the files that it names."""
        digest = hashlib.sha256(self.spec.text().encode())
        for path in self._named_files():
            try:
                digest.update(hashlib.sha256(path.read_bytes()).digest())
            except OSError as error:
                raise DdctError(f'cannot be read ({error.strerror})', place=path) from error
        for controller in self.controllers:
            digest.update(repr(sorted(controller.digests.items())).encode())
        return digest.hexdigest()

    def _named_files(self) -> Iterator[Path]:
        """Yield the scenarios and profiles that are files of the user."""
        for file in (base.file for base in self.bases.values()):
            if not is_packaged(file.name):
                yield Path(file.name)
            for section in file.content.values():
                if isinstance(section, Mapping) and _CSV in section:
                    yield Path(file.name).parent / section[_CSV]
        for key in self.spec.keys:
            for value in self.spec.values_of(key):
                placed = self.placed(key, value)
                if key.endswith(FILE_KEY):
                    yield Path(placed)
                elif isinstance(placed, Mapping) and _CSV in placed:
                    yield Path(placed[_CSV])

    def placed(self, key: str, value: Any) -> Any:
        """Return a value; if it names a file, with the folder in front."""
        if type(value) in (float, int):
            return value
        if key.endswith(FILE_KEY) and isinstance(value, str):
            return str(self.spec.folder / value)
        if isinstance(value, Mapping) and isinstance(value.get(_CSV), str):
            return {**value, _CSV: str(self.spec.folder / value[_CSV])}
        return value
