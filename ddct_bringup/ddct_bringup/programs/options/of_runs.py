# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Options that several programs have, and their values as arguments of the Python interface."""

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from ddct_bringup.api import shell
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.choices.command_line import (
    add_case_option,
    add_option,
    add_scenario_options,
)
from ddct_plant.scenario.choices.scenarios import CHOICES
from ddct_plant.scenario.choices.settings import SETTINGS

ALL = 'all'
"""Value of --controllers that selects every controller."""
DEFAULT_PORT = 8765
"""Default port of Foxglove's WebSocket connection."""
USUAL, NONE = 'usual', 'none'
"""Values of --floors."""


def add_settings_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe a run to a program's parser."""
    add_scenario_options(parser)
    add_case_option(parser)
    for name, described in SETTINGS.items():
        add_option(parser, name, described)
    parser.add_argument(
        '--duration', type=float, metavar='S', help="length of the run; default: the scenario's"
    )
    parser.add_argument('--list', action='store_true', help='print what can be chosen, and end')


def add_run_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe a run and its process layout to a program's parser."""
    add_settings_options(parser)
    add_layout_options(parser)
    parser.add_argument('--overwrite', action='store_true', help='replace an earlier result')


def add_layout_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the process layout to a program's parser, as `layout`."""
    layout = parser.add_mutually_exclusive_group()
    layout.add_argument(
        '--single-process',
        action='store_const',
        const='single-process',
        default='processes',
        dest='layout',
        help='all nodes in one process',
    )
    layout.add_argument(
        '--headless', action='store_const', const='headless', dest='layout', help='no ROS graph'
    )


def add_workers_option(parser: argparse._ActionsContainer) -> None:
    """Add --workers to a parser or to a group of one."""
    parser.add_argument(
        '--workers', type=int, metavar='N', help='processes here; default: one for each core'
    )


def add_controllers_option(parser: argparse.ArgumentParser) -> None:
    """Add --controllers to a program's parser; `controllers_of` parses its value."""
    parser.add_argument(
        '--controllers',
        default=ALL,
        metavar='A,B,...|all',
        help='names of --list, or controller files, .py or .yaml; default: %(default)s',
    )


def add_limits_option(parser: argparse.ArgumentParser) -> None:
    """Add the option --limits to a parser; its value is an argument of `load_limits`."""
    parser.add_argument(
        '--limits',
        type=Path,
        metavar='FILE',
        help='limits to judge runs by, see docs/use/judging.md; default: the packaged ones',
    )


def add_floors_option(parser: argparse.ArgumentParser) -> None:
    """Add the option --floors to a parser; `wants_floors` reads it."""
    parser.add_argument(
        '--floors',
        default=USUAL,
        choices=(USUAL, NONE),
        help='whether to compare the peak jerk with the least of its case, see docs/use/limit.md; '
        'default: %(default)s',
    )


def wants_floors(options: argparse.Namespace) -> bool:
    """Return whether runs are compared with the least of their case."""
    return options.floors != NONE


def add_columns_option(parser: argparse.ArgumentParser) -> None:
    """Add --columns to the options of a program that reads logs of other tools as well as bags."""
    parser.add_argument(
        '--columns',
        metavar='FILE',
        help='column map of a log: which column holds which quantity',
    )


def add_live_option(parser: argparse.ArgumentParser) -> None:
    """Add the option --live to a parser; `execution` reads it."""
    parser.add_argument(
        '--live',
        nargs='?',
        type=int,
        const=DEFAULT_PORT,
        metavar='PORT',
        help=f'let Foxglove watch; the run waits for it; PORT is {DEFAULT_PORT} unless given',
    )


def execution(options: argparse.Namespace) -> 'Callable[..., shell.Recording | None]':
    """
    Return how a run is executed: as `run_with_progress`, and shown in Foxglove with --live.

    Raise ParameterError for --live in another layout than a process per node.
    """
    if options.live is None:
        return shell.run_with_progress
    if options.layout != 'processes':
        raise ParameterError(f'--live shows a process per node: drop it or --{options.layout}')
    return partial(_execute, options.live)


def _execute(
    port: int, plan: 'shell.RunPlan', folder: Path, label: str = ''
) -> 'shell.Recording | None':
    with shell.live_view(port, plan.names) as view:
        return shell.run_with_progress(plan, folder, label, view)


def settings_given(options: argparse.Namespace) -> dict[str, Any]:
    """Return what the options of `add_settings_options` give, as arguments of `base_from`."""
    return {
        **{name: getattr(options, name) for name in CHOICES},
        'set': shell.changes_of(options.overrides),
        'duration': options.duration,
        'case': shell.case_values(options.case),
        **{name: getattr(options, name) for name in SETTINGS},
    }
