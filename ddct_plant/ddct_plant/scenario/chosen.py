# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The scenario that the options of a program choose."""

import argparse
import sys
from collections.abc import Sequence

from ddct_plant.base.errors import printable
from ddct_plant.scenario.choices.command_line import choice_of
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.scenario import Scenario


def scenario_of(options: argparse.Namespace, overrides: Sequence[str]) -> Scenario:
    """Return the chosen scenario with overrides; print `adjusted` on standard error."""
    scenario = ScenarioFile.read(choice_of(options)).scenario(overrides)
    print_adjusted(scenario)
    return scenario


def print_adjusted(scenario: Scenario) -> None:
    """Print the lines on adjusted values of a scenario on standard error."""
    for line in scenario.adjusted:
        print(f'scenario {printable(scenario.name)}: {printable(line)}', file=sys.stderr)
