# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Command-line options shared by the programs that run controllers."""

import argparse
from collections.abc import Iterable, Sequence

from ddct_controllers.registry import (
    controller_label,
    controller_names,
    controller_spec,
)
from ddct_plant.base.clutch_kinds import CLUTCHES
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.option import option_rows
from ddct_plant.base.options import Option, options_of, require_known
from ddct_plant.files.input_file import located
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.scheduling import Scheduling
from ddct_plant.program.table import Table, Weight, with_reasons
from ddct_plant.scenario.choices.command_line import add_option, add_scenario_options
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.choices.settings import ARCHITECTURES, MODES
from ddct_plant.scenario.settings import RunSettings

ALL = 'all'
"""Value of --controllers that selects every controller."""


def add_settings_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe a run to a program's parser."""
    add_scenario_options(parser)
    for name, described in options_of(RunSettings).items():
        add_option(parser, name, described)
    parser.add_argument(
        '--duration', type=float, metavar='S', help="length of the run; default: the scenario's"
    )
    parser.add_argument('--list', action='store_true', help='print what can be chosen, and end')


def add_run_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe a run and its process layout to a program's parser."""
    add_settings_options(parser)
    add_layout_options(parser)
    add_scheduling_options(parser)
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


def add_scheduling_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `Scheduling` to a program's parser; `scheduling_of` reads them."""
    described = options_of(Scheduling)
    add_option(parser, 'realtime_priority', described['realtime_priority'])
    parser.add_argument(
        '--lock-memory', action='store_true', help=described['lock_memory'].meaning
    )
    parser.add_argument('--cpus', default='', metavar='LIST', help=described['cpus'].meaning)


def scheduling_of(options: argparse.Namespace) -> Scheduling:
    """Return what the options of `add_scheduling_options` ask for; raise ParameterError."""
    return Scheduling(**{name: getattr(options, name) for name in options_of(Scheduling)})


def add_controllers_option(parser: argparse.ArgumentParser) -> None:
    """Add --controllers to a program's parser; `controllers_of` parses its value."""
    parser.add_argument(
        '--controllers',
        default=ALL,
        metavar='A,B,...|all',
        help='names of --list, or controller files, .py or .yaml; default: %(default)s',
    )


def controllers_of(text: str) -> list[str]:
    """
    Return the controllers in the value of --controllers.

    Raise ParameterError for none, and for one that is given twice.
    """
    if text == ALL:
        return controller_names()
    names = [name.strip() for name in text.split(',') if name.strip()]
    if not names:
        raise ParameterError('--controllers is empty: name at least one, or all')
    labels = [controller_label(name) for name in names]
    for label in labels:
        if labels.count(label) > 1:
            raise ParameterError(f'--controllers names {label} twice: name each once')
    return names


def metrics_of(
    option: str, text: str, known: Iterable[str], advice: str = 'name at least one'
) -> list[str]:
    """
    Return the metrics in the value of an option, each once.

    Raise ParameterError for none, and for an unknown one.
    """
    names = [name.strip() for name in text.split(',') if name.strip()]
    with located(option):
        require_known(names, known, 'metric')
    if not names:
        raise ParameterError(f'{option} is empty: {advice}', key=option)
    return list(dict.fromkeys(names))


def print_choices() -> None:
    """Print the controllers, architectures, scenarios and other choices, then the options."""
    rows: Sequence[tuple[str, Sequence[str]]] = (
        ('controllers', controller_names()),
        ('architectures', ARCHITECTURES),
        ('scenarios', scenario_names()),
        ('clutches', CLUTCHES),
        ('modes', MODES),
    )
    for title, names in rows:
        print_note(f'{title}: {", ".join(names)}')
    print()
    print_table(controller_options_table())


def controller_options_table() -> Table:
    """Return the table of controllers' options, a row for all that declare the same option."""
    takers: dict[tuple[str, ...], list[str]] = {}
    for name in controller_names():
        try:
            options = controller_spec(name).options or {}
        except DdctError as error:  # a third party's controller that cannot be loaded
            options = {'-': Option(None, str(error))}
        for row in option_rows(options):
            takers.setdefault(row[:-1], []).append(name)
    table = Table(
        'options of controllers, set by --set controllers.NAME.KEY=VALUE',
        ('KEY', 'NAME', 'default', 'meaning', 'unit', 'range'),
        [
            (key, ', '.join(names), default, meaning, unit, limits)
            for (key, unit, default, limits, meaning), names in takers.items()
        ],
        numbers=[False] * 6,
        weights=(
            *(Weight.IDENTIFYING, Weight.IDENTIFYING, Weight.NEEDED, Weight.NEEDED),
            *(Weight.USEFUL, Weight.DETAIL),
        ),
    )
    return with_reasons(table, lambda header, row: 'the controller cannot be loaded')
