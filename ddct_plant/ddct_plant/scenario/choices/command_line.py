# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Command-line options that choose a scenario, its overrides and described values."""

import argparse

from ddct_plant.base.options import Option
from ddct_plant.scenario.choices.scenarios import (
    DEFAULT_CAR,
    DEFAULT_SCENARIO,
    Choice,
    packaged_names,
    scenario_names,
)

_METAVARS = {float: 'X', int: 'N', str: 'NAME'}
SET_EXAMPLE, CASE_EXAMPLE = 'load.slope_rad=0.05', 'vehicle.mass_kg=1700'


def add_scenario_options(
    parser: argparse._ActionsContainer, *, set_example: str = SET_EXAMPLE
) -> None:
    """Add --scenario, --car and --drive, and --set as `overrides`; `choice_of` reads the first."""
    default = f'default: {DEFAULT_SCENARIO}, or none with --drive'
    parser.add_argument(
        '--scenario',
        metavar='NAME|FILE',
        help=f'one of {", ".join(scenario_names())}, or a YAML file; {default}',
    )
    for noun, otherwise in (
        ('car', f'that of the scenario; without one {DEFAULT_CAR}'),
        ('drive', 'that of the scenario'),
    ):
        parser.add_argument(
            f'--{noun}',
            metavar='NAME|FILE',
            help=f'{noun} in place of {otherwise}: one of {", ".join(packaged_names(noun))}, or '
            'a YAML file',
        )
    parser.add_argument(
        '--set',
        action='append',
        default=[],
        metavar='KEY=VALUE',
        dest='overrides',
        help=f'change a scenario key, such as {set_example}; may be repeated',
    )


def add_case_option(parser: argparse._ActionsContainer) -> None:
    """Add --case, whose texts `case_values` reads."""
    parser.add_argument(
        '--case',
        action='append',
        default=[],
        metavar='KEY=VALUE|FILE',
        help=f'what the plant alone has and no controller knows, such as {CASE_EXAMPLE}: a key of '
        'the car or the drive, a wear gain or the seed, or a YAML file of keys; may be repeated',
    )


def choice_of(options: argparse.Namespace) -> Choice:
    """Return what --scenario, --car and --drive choose."""
    return Choice(options.scenario, options.car, options.drive)


def add_option(parser: argparse.ArgumentParser, name: str, described: Option) -> None:
    """Add the option `--name` for a described value, which is checked where it is used."""
    parser.add_argument(
        f'--{name.replace("_", "-")}',
        type=described.kind,
        default=described.default,
        metavar=_METAVARS[described.kind],
        help=f'{described.description}; default: %(default)s',
    )
