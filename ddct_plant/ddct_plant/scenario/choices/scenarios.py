# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The scenarios that come with the package; cheap to import."""

from pathlib import Path


def scenario_names() -> list[str]:
    """Return the names of the scenarios that come with the package."""
    return sorted(file.stem for file in packaged_scenarios().glob('*.yaml'))


def packaged_scenarios() -> Path:
    """Return the folder of the scenarios that come with the package."""
    return Path(__file__).parents[1] / 'packaged'
