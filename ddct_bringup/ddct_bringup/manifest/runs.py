# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plan of a result that is one run or several: settings, controller and layout of each."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.manifest.inputs import INPUTS, InputFiles
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import ITSELF, RUNS, begin_manifest
from ddct_bringup.run.plan import LAYOUTS, RunPlan
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.from_file.digests import controller_files, handover_files
from ddct_controllers.registry import controller_label
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.content import scenario_content, scenario_from_mapping
from ddct_plant.scenario.settings import RunSettings, is_handover_file


@dataclass(frozen=True)
class PlannedRun:
    """Inputs of one run, from which it can be repeated."""

    controller: str | None
    """
    Name of the controller, or the place of its file in the inputs; None where it was an object of
    a Python program.
    """
    layout: str
    """Process layout, as in `RunPlan`."""
    settings: Mapping[str, str | float]
    """Values of `RunSettings` by name; a handover's file by its place in the inputs."""
    scenario: Mapping[str, Any]
    """Content of the scenario that controllers know, with the points of its profiles."""
    true_scenario: Mapping[str, Any] | None
    """Content of the scenario of the case, where it differs."""

    def __post_init__(self) -> None:
        """Raise ParameterError for an unknown layout."""
        if self.layout not in LAYOUTS:
            raise ParameterError(
                f'unknown layout {self.layout!r}: choose from {", ".join(LAYOUTS)}', key='layout'
            )

    @classmethod
    def of(cls, plan: RunPlan, inputs: InputFiles) -> 'PlannedRun':
        """Return the inputs of a run, and take the files of the user into `inputs`."""
        settings = plan.settings
        chosen = plan.controller if isinstance(plan.controller, str) else None
        if chosen is not None and is_controller_file(chosen):
            chosen = inputs.add(controller_files(chosen))
        values = settings.values
        if is_handover_file(settings.known.handover):
            values['handover'] = inputs.add(handover_files(settings.known.handover))
        true = settings.case.scenario
        return cls(
            chosen,
            plan.layout,
            values,
            scenario_content(settings.known.scenario),
            scenario_content(true) if true else None,
        )

    def run_settings(self, result: Path) -> RunSettings:
        """Return the settings; raise DdctError where this version cannot build them."""
        values: dict[str, Any] = dict(self.settings)
        if is_handover_file(str(values['handover'])):
            values['handover'] = str(result / INPUTS / values['handover'])
        true = self.true_scenario
        return RunSettings.of(
            scenario_from_mapping(self.scenario),
            values,
            scenario_from_mapping(true) if true else None,
        )

    def headless_plan(self, result: Path) -> RunPlan:
        """Return the plan of the repetition; raise DdctError where it cannot be made."""
        if self.controller is None:
            raise DdctError(
                'its controller was an object of a Python program, and cannot be made again: '
                'record it with a controller file'
            )
        return RunPlan(self.run_settings(result), self._chosen(result), 'headless')

    def label(self, result: Path) -> str:
        """Return the name of the controller in its bag; '' where it was an object."""
        return controller_label(self._chosen(result)) if self.controller else ''

    def _chosen(self, result: Path) -> str:
        """Return the name of the controller, or the path of its file in the inputs."""
        chosen = self.controller or ''
        return str(result / INPUTS / chosen) if is_controller_file(chosen) else chosen


@dataclass(frozen=True)
class ComparisonPlan:
    """What the scores and the page of a comparison depend on besides its runs."""

    limits: NamedLimits
    floors: bool
    """Whether the scores have the peak jerk over the least."""


@dataclass(frozen=True)
class RunsPlan:
    """Plan of a result of the kind RUNS."""

    runs: Mapping[str, PlannedRun]
    """Inputs of each run by the folder of its bag in the result."""
    comparison: ComparisonPlan | None
    """None where the result has no scores, loop analyses and page."""


def begin_comparison(
    result: Path, plans: Mapping[str, RunPlan], limits: Limits, *, floors: bool
) -> None:
    """
    Begin a result of compared runs, by the folders of their bags, with its inputs and manifest.

    Raise DdctError when a file cannot be read or written.
    """
    inputs = InputFiles()
    runs = {name: PlannedRun.of(plan, inputs) for name, plan in plans.items()}
    comparison = ComparisonPlan(NamedLimits.of(limits, inputs), floors)
    begin_manifest(result, RUNS, RunsPlan(runs, comparison), inputs)


def begin_run(result: Path, plan: RunPlan) -> None:
    """Begin a result that is the bag of one run; raise DdctError as `begin_comparison`."""
    inputs = InputFiles()
    runs = {ITSELF: PlannedRun.of(plan, inputs)}
    begin_manifest(result, RUNS, RunsPlan(runs, None), inputs)
