# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The latched `run_info` message: version and settings of a node."""

from collections.abc import Mapping

from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.file import scenario_digest
from ddct_plant.scenario.settings import RunSettings


def run_info_pairs(
    settings: RunSettings, extra: Mapping[str, str] | None = None
) -> tuple[tuple[str, str], ...]:
    """Return the (key, value) pairs of a node's `run_info`, equal in graph and headless runs."""
    return (
        ('version', package_version()),
        ('scenario', settings.scenario.name),
        ('scenario_digest', scenario_digest(settings.scenario)),
        ('architecture', settings.architecture),
        ('clutch', settings.clutch),
        ('wear_gain', repr(settings.wear_gain)),
        ('mode', settings.mode),
        ('seed', str(settings.seed)),
        *(extra or {}).items(),
    )
