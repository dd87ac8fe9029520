# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The runs of a campaign, from its specification, and the digest of all that they depend on."""

from typing import Any

from ddct_bringup.campaign.keys import CONTROLLERS
from ddct_bringup.campaign.run_set import RunSet
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign.specification.named_files import digest_of, placed
from ddct_bringup.campaign.specification.parts import MOST_RUNS, RANDOM, VARY
from ddct_bringup.run.run_base import RunBase
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import ParameterError

_GEARS = 'gear', 'shift.off_going_gear'
_GEARBOX = 'gearbox'


class Campaign(RunSet):
    """The runs that a specification describes, and a digest of what they depend on."""

    def __init__(self, spec: CampaignSpec) -> None:
        """Read the files that the specification names; raise DdctError for a missing one."""
        self.spec = spec
        self._names = spec.chosen
        controllers = [controller_spec(each) for each in self._names]
        labels = [each.name for each in controllers]
        for label in labels:
            if labels.count(label) > 1:
                raise ParameterError(
                    f'{CONTROLLERS}: two are called {label}: rename one', key=CONTROLLERS
                )
        super().__init__(
            controllers=controllers,
            bases={
                choice: RunBase(spec.scenario_file(choice), {}, {}, labels)
                for choice in spec.choices
            },
            common=spec.common,
            grid=spec.grid,
            samples=spec.samples,
            of=spec.of,
            vary=spec.vary,
            known=spec.known,
            root=spec.root,
        )
        if self.runs > MOST_RUNS:
            raise ParameterError(f'{self.runs} runs: give at most {MOST_RUNS}', key='runs')
        self._require_gears()

    def _require_gears(self) -> None:
        """Raise ParameterError for a gear to draw that a car does not have."""
        drawn = [key for key in _GEARS if key in self.vary]
        if not drawn or any(key.startswith(_GEARBOX) for key in self.spec.keys):
            return
        for base in self.bases.values():
            gearbox = base.file.scenario().gearbox
            for key in drawn:
                for gear in self.vary[key].values or self.vary[key].ends:
                    gearbox.require_gear(f'{RANDOM}.{VARY}.{key}', gear)

    def chosen(self, index: int) -> str:
        """Return the name of a run's controller, or the path of its file."""
        return self._names[index // self.cases]

    def digest(self) -> str:
        """Return a hash of the specification and of the files that it names."""
        return digest_of(self.spec)

    def placed(self, key: str, value: Any) -> Any:
        """Return a value; if it names a file, with the folder in front."""
        return placed(key, value, lambda name: str(self.spec.folder / name))
