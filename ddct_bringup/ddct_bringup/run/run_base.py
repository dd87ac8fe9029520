# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings of runs from a scenario, changed keys and options; the only constructor of them."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from ddct_controllers.registry import require_known_controllers
from ddct_plant.base.options import options_of
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.overrides import parsed_override
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.parameters import SensorParameters

_SETTINGS = options_of(RunSettings)
_NOTHING: Mapping[str, Any] = {}
_KNOWN = (
    *('architecture', 'clutch', 'handover', 'controllers', 'sensors'),
    *('name', 'description', 'duration_s', 'control_start_s', 'score_window_s', 'pedal_position'),
    *('reference', 'slip_reference', 'engine_speed_reference', 'closing'),
)
"""
Keys, and sections, that are known where they vary: what a row is, and what no plant has.

To vary a reference for the plant alone would change nothing. Drawn sensors are not known.
"""


@dataclass(frozen=True)
class RunBase:
    """Common settings of runs, before keys are varied."""

    file: ScenarioFile
    """Scenario of the runs without changes."""
    changes: Mapping[str, Any]
    """Values by dotted scenario key, as `--set` gives them."""
    settings: Mapping[str, Any]
    """Values of `RunSettings` by name, such as `wear_gain`."""
    labels: Sequence[str]
    """Names of the controllers, since `changes` may contain options of theirs."""
    _last_known: dict[str, Scenario] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """The known scenario of the last runs that had one, by its changes."""

    @cached_property
    def _unchanged(self) -> Scenario:
        """Scenario of the runs without changes."""
        return self._built(_NOTHING)

    def at(self, varied: Mapping[str, Any] = _NOTHING, drawn: Collection[str] = ()) -> RunSettings:
        """
        Return the settings with values by key: those of `RunSettings`, or dotted scenario keys.

        Dependent values change with them, as with `--set`. What controllers know has of `varied`
        the keys of `_KNOWN` alone, and of them no sensors that are `drawn`. Raise DdctError for
        values that cannot be used.
        """
        settings = {**self.settings, **{key: varied[key] for key in varied if key in _SETTINGS}}
        of_scenario = {key: varied[key] for key in varied if key not in _SETTINGS}
        known = {key: of_scenario[key] for key in of_scenario if _is_known(key, drawn)}
        scenario = self._scenario(self._with(of_scenario))
        if len(known) == len(of_scenario):
            return RunSettings(scenario, **settings)
        known_scenario = self._known_scenario(self._with(known))
        if scenario.sensors is not None and known_scenario.sensors is None:
            # That there are sensors is known, since other topics carry their measurements.
            known_scenario = replace(known_scenario, sensors=SensorParameters())
        return RunSettings(scenario, **settings, known_scenario=known_scenario)

    def _with(self, varied: Mapping[str, Any]) -> Mapping[str, Any]:
        ours = {key: value for key, value in self.changes.items() if key not in varied}
        return {**ours, **varied}

    def _known_scenario(self, changes: Mapping[str, Any]) -> Scenario:
        """Return the scenario that controllers know, which most runs share, with some changes."""
        key = repr(changes)
        if key not in self._last_known:
            self._last_known.clear()
            self._last_known[key] = self._scenario(changes)
        return self._last_known[key]

    def _scenario(self, changes: Mapping[str, Any]) -> Scenario:
        """Return the scenario with changes by dotted key; without any it is built once."""
        return self._built(changes) if changes else self._unchanged

    def _built(self, changes: Mapping[str, Any]) -> Scenario:
        scenario = self.file.scenario(changes)
        require_known_controllers(scenario, self.labels)
        return scenario


def _is_known(key: str, drawn: Collection[str]) -> bool:
    """Return whether controllers know the value of a varied key."""
    section = key.partition('.')[0]
    return section in _KNOWN and not (section == 'sensors' and key in drawn)


def changes_of(overrides: Sequence[str]) -> dict[str, object]:
    """Return the values by dotted key of overrides KEY=VALUE; raise DdctError for another text."""
    changes: dict[str, object] = {}
    for key, value in map(parsed_override, overrides):
        changes.pop(key, None)  # the last of a repeated key counts, in its place
        changes[key] = value
    return changes
