# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `design least-jerk`: the controller `least_jerk` as C for a control unit."""

import argparse
from pathlib import Path
from typing import Any

from ddct_controllers.least_jerk.controller import NAME, SPEC
from ddct_controllers.least_jerk.export.export_least_jerk import export_least_jerk
from ddct_controllers.registry import make_controller, require_known_controllers
from ddct_plant.base.clutch_kinds import CLUTCHES, STICK_SLIP
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.chosen import scenario_of
from ddct_plant.scenario.settings import RunSettings

_DESCRIPTION = """\
Write the controller least_jerk as self-contained C99 for a control unit:
docs/controllers/control_unit.md."""
_EPILOG = """\
examples:
  ddct design least-jerk --export control_unit --scenario launch
  ddct design least-jerk --export control_unit --scenario upshift --overwrite"""


def add_parser(subparsers: Any) -> None:
    """Add `least-jerk` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'least-jerk',
        help='the controller least_jerk as C for a control unit',
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--export', type=Path, metavar='DIR', required=True, help='folder of the C files'
    )
    add_scenario_options(parser, set_example=f'controllers.{NAME}.jerk_m_s3=5')
    parser.add_argument(
        '--clutch', choices=CLUTCHES, default=STICK_SLIP, help=f'(default: {STICK_SLIP})'
    )
    parser.add_argument('--overwrite', action='store_true', help='replace an earlier export')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the C, print the names of its files, and return the exit code."""
    scenario = scenario_of(options, options.overrides)
    settings = RunSettings(scenario, clutch=options.clutch)
    require_known_controllers(scenario, [NAME])
    controller = make_controller(SPEC, settings)
    for path in export_least_jerk(
        controller, settings, options.export, overwrite=options.overwrite
    ):
        print(path)
    return 0
