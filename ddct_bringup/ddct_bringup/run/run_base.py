# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings of runs from a scenario, changed keys, a case and options; made here alone."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ddct_controllers.registry import require_known_controllers
from ddct_plant.files.input_file import located
from ddct_plant.scenario.case import CaseOf, is_always_known, require_of_case
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.overrides import parsed_override
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.parameters import SensorParameters

_NOTHING: Mapping[str, Any] = {}


@dataclass(frozen=True)
class RunBase:
    """Common settings of runs, before keys are varied."""

    file: ScenarioFile
    """Scenario of the runs without changes."""
    changes: Mapping[str, Any]
    """Values by dotted scenario key, as `--set` gives them."""
    settings: Mapping[str, Any]
    """Values of `SETTINGS` by name, such as `architecture`."""
    labels: Sequence[str]
    """Names of the controllers, since `changes` may contain options of theirs."""
    case: Mapping[str, Any] = field(default_factory=dict)
    """Values of the case by dotted key, as `--case` gives them."""
    _last: dict[str, CaseOf] = field(default_factory=dict, init=False, repr=False, compare=False)
    """Cases of the last known scenario, which most runs share, by what it was made of."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a case with a key that controllers know in any run."""
        with located('case'):
            require_of_case(self.case)

    def at(
        self,
        varied: Mapping[str, Any] = _NOTHING,
        drawn: Collection[str] = (),
        known: Collection[str] = (),
    ) -> RunSettings:
        """
        Return the settings with values by key: those of `SETTINGS`, or dotted scenario keys.

        Values that vary are of the case, but for those that each run knows, those with a key in
        `known`, and sensors that are not `drawn`. Dependent values change with them, as with
        `--set`. Raise DdctError for values that cannot be used.
        """
        given = {**self.case, **varied}
        of_run = {key: given[key] for key in given if key in SETTINGS}
        learnt = {
            key: varied[key]
            for key in varied
            if key not in SETTINGS and _is_known(key, drawn, known)
        }
        others = {*SETTINGS, *learnt}
        overrides = {key: given[key] for key in given if key not in others}
        values = {**self.settings, **of_run}
        sensed = any(_section(key) == 'sensors' for key in overrides if key in varied)
        cases = self._cases(learnt, sensed=sensed)
        return RunSettings.of(cases.known, values, cases.scenario(overrides))

    def _cases(self, learnt: Mapping[str, Any], *, sensed: bool) -> CaseOf:
        """
        Return the cases of the scenario with these values, as controllers know it.

        Where drawn values make it `sensed`, that there are sensors is known, since other topics
        carry their measurements.
        """
        key = repr((learnt, sensed))
        if key not in self._last:
            ours = {each: self.changes[each] for each in self.changes if each not in learnt}
            changes = {**ours, **learnt}
            scenario = self.file.scenario(changes)
            require_known_controllers(scenario, self.labels)
            if sensed and scenario.sensors is None:
                scenario = replace(scenario, sensors=SensorParameters())
            self._last.clear()
            self._last[key] = CaseOf(scenario, self.file.of_cases(scenario, changes))
        return self._last[key]


def _is_known(key: str, drawn: Collection[str], known: Collection[str]) -> bool:
    """Return whether controllers know the value of a varied key."""
    of_sensors = _section(key) == 'sensors' and key not in drawn
    return key in known or of_sensors or is_always_known(key)


def _section(key: str) -> str:
    return key.partition('.')[0]


def changes_of(overrides: Sequence[str]) -> dict[str, object]:
    """Return the values by dotted key of overrides KEY=VALUE; raise DdctError for another text."""
    changes: dict[str, object] = {}
    for key, value in map(parsed_override, overrides):
        changes.pop(key, None)  # the last of a repeated key counts, in its place
        changes[key] = value
    return changes
