# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings of runs from a scenario, changed keys and options; the only constructor of them."""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ddct_controllers.registry import require_known_controllers
from ddct_plant.base.options import options_of
from ddct_plant.models.clutch import LINEAR
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.options import print_adjusted
from ddct_plant.scenario.overrides import parsed_override
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings

_SETTINGS = options_of(RunSettings)
_NOTHING: Mapping[str, Any] = {}


@dataclass(frozen=True)
class RunBase:
    """Common settings of runs, before keys are varied."""

    file: ScenarioFile
    """Scenario of the runs without changes."""
    changes: Mapping[str, Any]
    """Values by dotted scenario key, as `--set` gives them."""
    settings: Mapping[str, Any]
    """Values of `RunSettings` by name, such as `clutch`."""
    labels: Sequence[str]
    """Names of the controllers, since `changes` may contain options of theirs."""
    _unchanged: dict[str, Scenario] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """Scenario of the runs without changes, by clutch."""

    def at(self, varied: Mapping[str, Any] = _NOTHING) -> RunSettings:
        """
        Return the settings with values by key: those of `RunSettings`, or dotted scenario keys.

        Dependent values change with them, as with `--set`. Raise DdctError for values that cannot
        be used.
        """
        settings = {**self.settings, **{key: varied[key] for key in varied if key in _SETTINGS}}
        ours = {key: value for key, value in self.changes.items() if key not in varied}
        changes = ours | {key: varied[key] for key in varied if key not in _SETTINGS}
        return RunSettings(self._scenario(changes, settings.get('clutch', LINEAR)), **settings)

    def _scenario(self, changes: Mapping[str, Any], clutch: str) -> Scenario:
        """Return the scenario with changes by dotted key; without any it is built once."""
        key = str(clutch)  # what is no name is refused with the settings
        if not changes and key in self._unchanged:
            return self._unchanged[key]
        scenario = self.file.scenario(changes, clutch)
        require_known_controllers(scenario, self.labels)
        if not changes:
            self._unchanged[key] = scenario
        return scenario


def base_of(options: argparse.Namespace, labels: Sequence[str]) -> RunBase:
    """Return the common settings of runs with these controllers from program options."""
    changes: dict[str, object] = {}
    for key, value in map(parsed_override, options.overrides):
        changes.pop(key, None)  # the last of a repeated key counts, in its place
        changes[key] = value
    if options.duration is not None:
        changes['duration_s'] = options.duration
    settings = {name: getattr(options, name) for name in _SETTINGS}
    return RunBase(ScenarioFile.read(options.scenario), changes, settings, labels)


def settings_of(options: argparse.Namespace, labels: Sequence[str]) -> RunSettings:
    """
    Return the settings of one run, or of runs, with the controllers called `labels`.

    Print adjusted values of the scenario on standard error. Raise DdctError for values that
    cannot be used.
    """
    settings = base_of(options, labels).at()
    print_adjusted(settings.scenario)
    return settings
