# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The scenarios, cars and drives that come with the package; cheap to import."""

from pathlib import Path

_SCENARIO = 'scenario'
DEFAULT_SCENARIO = 'thesis'
"""Scenario of a run that names neither a scenario nor a car or a drive."""
DEFAULT_CAR = 'c635'
"""Car of a drive that is given without one."""


def scenario_names() -> list[str]:
    """Return the names of the scenarios that come with the package."""
    return packaged_names(_SCENARIO)


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
