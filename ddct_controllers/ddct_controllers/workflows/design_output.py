# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Common parts of both design methods: options, a free name, tables, JSON, and the files."""

import argparse
import shlex
from collections.abc import Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.from_file.controller_file import require_name
from ddct_controllers.from_file.designed import DesignedController, load_designed
from ddct_controllers.registry import controller_names
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.output_file import STDOUT, require_new, write_text
from ddct_plant.program.command_line import number_in, show_and_write
from ddct_plant.program.printed_table import print_tables
from ddct_plant.program.table import TextTable
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.chosen import scenario_of
from ddct_plant.scenario.differences import changed_values, scenario_title
from ddct_plant.scenario.scenario import Scenario

OptionTable = Mapping[str, Mapping[str, Any]]
"""Arguments of `add_argument` by the option's name."""
_OPTIONS: OptionTable = {
    '--rise-time': {'type': number_in('s'), 'metavar': 'S', 'help': 'longest rise time'},
    '--overshoot': {'type': number_in('%'), 'metavar': 'PERCENT', 'help': 'largest overshoot'},
    '--name': {'metavar': 'NAME', 'help': 'name of the controller (default: mine)'},
    '--out': {'type': Path, 'metavar': 'DIR', 'help': 'write the controller and its charts'},
    '--overwrite': {
        'action': 'store_true',
        'default': None,
        'help': 'replace an earlier design',
    },
    '--json': {'metavar': 'FILE', 'help': 'write all results; - is standard output'},
}


def add_design_options(parser: argparse.ArgumentParser, own: OptionTable) -> None:
    """Add a method's own options, specifications, and outputs; None is an option not set."""
    for name, settings in {**own, **_OPTIONS}.items():
        parser.add_argument(name, **settings)
    add_scenario_options(parser, set_example='driveline.halfshaft_stiffness=8000')


def chosen_plant(options: argparse.Namespace) -> tuple[Scenario, str]:
    """Return the scenario whose driveline and actuator a design is for, and its title."""
    scenario = scenario_of(options, options.overrides)
    return scenario, scenario_title(scenario.name, changed_values(scenario))


def fraction_of(percent: float) -> float:
    """Return an overshoot in % as a fraction; raise ParameterError for one given as a fraction."""
    if 0.0 < percent < 1.0:
        raise ParameterError(
            f'--overshoot {percent:g} is below 1 %: give per cent, such as {100.0 * percent:g}',
            key='overshoot',
        )
    return percent / 100.0


def free_name(options: argparse.Namespace) -> str:
    """
    Return the design's name, checked before the work; raise DdctError when it is taken.

    `--overwrite` replaces only a file of a designed controller.
    """
    name: str = 'mine' if options.name is None else options.name
    require_name(name)
    if name in controller_names():
        raise ParameterError(f'--name {name} is taken by another controller: choose another')
    path = _path(options, name)
    if path and path.exists():
        require_new('--name', path, overwrite=options.overwrite)
        load_designed(str(path))
    return name


def show(options: argparse.Namespace, tables: Iterable[TextTable], record: object) -> None:
    """Print the tables unless standard output is for the JSON, and write that if requested."""
    show_and_write(options.json, record, partial(print_tables, tables))


def write_design(
    options: argparse.Namespace,
    designed: DesignedController,
    specifications: TimeSpecifications,
    scenario: Scenario,
) -> None:
    """Write charts and, last, the controller, if requested; raise DdctError on failure."""
    path = _path(options, designed.name)
    if not path:
        return
    # matplotlib takes most of a second to load.
    from ddct_controllers.design.drawing.charts import write_design_charts

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DdctError(f'--out {path.parent}: cannot be made ({error.strerror})') from error
    write_design_charts(
        path.parent, designed, specifications, scenario.driveline, scenario.actuator
    )
    write_text(str(path), designed.to_yaml())
    if options.json != STDOUT:
        run_it = ('ddct', 'compare', '--controllers', str(path), '--out', f'runs/{designed.name}')
        print(f'Run it: {shlex.join(run_it)}')


def _path(options: argparse.Namespace, name: str) -> Path | None:
    return options.out / f'{name}.yaml' if options.out else None
