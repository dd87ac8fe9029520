# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The scenarios, cars and drives that come with the package; cheap to import."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

CHOICES = ('scenario', 'car', 'drive')
"""Options that choose what is driven."""
DEFAULT_SCENARIO = 'thesis'
"""Scenario of a run that names neither a scenario nor a car or a drive."""
DEFAULT_CAR = 'c635'
"""Car of a drive that is given without one."""


@dataclass(frozen=True)
class Choice:
    """
    A scenario, car and drive as they were requested, by name or file; None where none was.

    A car or drive takes the place of that of the scenario, whose changed keys stay. Without a
    scenario a drive has the car `c635` unless another is given; else the scenario is `thesis`.
    """

    scenario: str | None = None
    car: str | None = None
    drive: str | None = None

    @classmethod
    def taken_from(cls, values: dict[str, Any]) -> 'Choice':
        """Return what the values by option choose, and take that out of them."""
        return cls(**{name: values.pop(name) for name in CHOICES if name in values})

    @property
    def given(self) -> dict[str, str]:
        """What was requested, by the name of its option."""
        found = ((name, getattr(self, name)) for name in CHOICES)
        return {name: value for name, value in found if value is not None}

    @property
    def whole_scenario(self) -> str | None:
        """Scenario whose car or drive is used, None where both are given or defaults."""
        if self.scenario is None and self.drive is None:
            return DEFAULT_SCENARIO
        return self.scenario


def scenario_names() -> list[str]:
    """Return the names of the scenarios that come with the package."""
    return packaged_names('scenario')


def car_names() -> list[str]:
    """Return the names of the cars that come with the package."""
    return packaged_names('car')


def drive_names() -> list[str]:
    """Return the names of the drives that come with the package."""
    return packaged_names('drive')


def packaged_names(noun: str) -> list[str]:
    """Return the packaged names of a noun: of cars, drives or scenarios."""
    return sorted(file.stem for file in _folder(noun).glob('*.yaml'))


def packaged_text(noun: str, name: str) -> str:
    """Return the text of a packaged file of a noun, by its name."""
    return (_folder(noun) / f'{name}.yaml').read_text(encoding='utf-8')


def is_packaged(name_or_file: str) -> bool:
    """Return whether it is the name of a packaged file rather than a path."""
    return '/' not in name_or_file and not name_or_file.endswith(('.yaml', '.yml'))


def _folder(noun: str) -> Path:
    return Path(__file__).parents[1] / 'packaged' / f'{noun}s'
