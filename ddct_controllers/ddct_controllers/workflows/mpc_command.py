# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `design mpc`: a predictive controller as C for a control unit."""

import argparse
from pathlib import Path
from typing import Any

from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_controllers.registry import (
    controller_label,
    make_controller,
    require_known_controllers,
)
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.chosen import scenario_of
from ddct_plant.scenario.settings import KnownSettings

_DESCRIPTION = """\
Write a predictive controller, with its observer and solver, as self-contained C99 for a
control unit: docs/controllers/files.md. `ddct thesis studies` has studies of them."""
_EPILOG = """\
examples:
  ddct design mpc --export control_unit
  ddct design mpc --export control_unit --controller mpc_offset_free --overwrite"""


def add_parser(subparsers: Any) -> None:
    """Add `mpc` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'mpc',
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--export', type=Path, metavar='DIR', required=True, help='folder of the C files'
    )
    parser.add_argument('--controller', metavar='NAME', default='mpc3', help='(default: mpc3)')
    add_scenario_options(parser, set_example='controllers.mpc3.torque_rate_n_m_s=500')
    parser.add_argument(
        '--architecture',
        choices=ARCHITECTURES,
        default='detailed',
        metavar='NAME',
        help=f'one of {", ".join(ARCHITECTURES)} (default: detailed)',
    )
    parser.add_argument('--overwrite', action='store_true', help='replace an earlier export')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the C, print the names of its files, and return the exit code."""
    settings = KnownSettings(
        scenario_of(options, options.overrides), architecture=options.architecture
    )
    require_known_controllers(settings.scenario, [controller_label(options.controller)])
    controller = make_controller(options.controller, settings)
    for path in export_controller(
        controller, options.controller, settings, options.export, overwrite=options.overwrite
    ):
        print(path)
    return 0
