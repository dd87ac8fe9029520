# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A tuning: a controller with its specification, the campaign of its cases, its present values."""

import os
from dataclasses import dataclass
from functools import cached_property

from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.rows import require_suitable
from ddct_bringup.tuning.loop_quantities import nominal_settings
from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class Tuning:
    """A tuning before it is carried out."""

    judged: Judged
    """Controller that is tuned."""
    spec: TuningSpec
    limits: Limits

    @cached_property
    def controller(self) -> ControllerSpec[Controller]:
        """Specification of the controller."""
        return controller_spec(self.judged.path)

    @cached_property
    def campaign(self) -> Campaign:
        """Campaign that contains the development cases."""
        folder, chosen = self.spec.folder, self.judged.path
        if is_controller_file(chosen):  # so that a moved result has the same specification
            chosen = os.path.relpath(chosen, folder)
        return self.spec.development.campaign(chosen, folder)

    @cached_property
    def cases(self) -> list[int]:
        """Development cases by their number in the campaign, in the order in which they run."""
        return self.spec.development.cases(self.campaign)

    @cached_property
    def settings(self) -> list[RunSettings]:
        """Settings of the first case of each scenario."""
        return nominal_settings(self.campaign, self.cases)

    @cached_property
    def untuned(self) -> Values:
        """
        Options that the scenarios give and that are not tuned.

        Raise ParameterError where they differ between scenarios: one file could not contain them.
        """
        name, options = self.controller.name, self.controller.options or {}
        given = [each.scenario.controllers.get(name, {}) for each in self.settings]
        defaults = {key: option.default for key, option in options.items()}
        tuned = {each.name for each in self.spec.parameters}
        found: dict[str, float] = {}
        for key in {key: None for each in given for key in each if key not in tuned}:
            values = [each.get(key, defaults.get(key)) for each in given]
            if any(value != values[0] for value in values):
                raise ParameterError(
                    f'parameters.{key} is missing: the scenarios have different values of it, '
                    'and the result can have one only',
                    key=f'parameters.{key}',
                )
            found[key] = values[0]
        return found

    @cached_property
    def present(self) -> dict[str, float]:
        """Values before the tuning, for its first trial; empty where one is outside its range."""
        given = self.settings[0].scenario.controllers.get(self.controller.name, {})
        options = self.controller.options or {}
        values: dict[str, float] = {}
        for each in self.spec.parameters:
            value = given.get(each.name, options[each.name].default)
            if not each.contains(value):
                return {}
            values[each.name] = value
        return values

    def with_values(self, values: Values) -> Campaign:
        """Return the campaign with the values of a trial."""
        name = self.controller.name
        return self.campaign.with_common(
            {f'controllers.{name}.{key}': value for key, value in values.items()}
        )

    def require_sound(self) -> None:
        """Build cases and controller, with its present or lowest values; raise DdctError."""
        lowest = {each.name: each.low for each in self.spec.parameters}
        campaign = self.with_values(self.present or lowest)
        assert self.untuned is not None
        for case in self.cases:
            campaign.run(case)
        require_suitable(self.controller, campaign.run(self.cases[0]).settings)


def tuning_of(chosen: str, spec: TuningSpec, limits: Limits) -> Tuning:
    """Return the tuning of a controller by name or file; raise DdctError where it is unusable."""
    return Tuning(Judged.of(chosen), spec, limits)
