# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What can be chosen for a run, by name: controllers, metrics, and what --list prints."""

from collections.abc import Iterable, Sequence

from ddct_controllers.registry import (
    controller_names,
    controller_spec,
)
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.option import option_rows
from ddct_plant.base.options import Option, require_known
from ddct_plant.files.input_file import located
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import TextTable, Weight, with_reasons
from ddct_plant.scenario.choices.scenarios import CHOICES, packaged_names
from ddct_plant.scenario.choices.settings import ARCHITECTURES, MODES


def metrics_of(option: str, text: str, known: Iterable[str]) -> list[str]:
    """
    Return the metrics in the value of an option, each once.

    Raise ParameterError for none, and for an unknown one.
    """
    names = [name.strip() for name in text.split(',') if name.strip()]
    with located(option):
        require_known(names, known, 'metric')
    if not names:
        raise ParameterError(f'{option} is empty: name at least one', key=option)
    return list(dict.fromkeys(names))


def print_choices() -> None:
    """Print the controllers, architectures, scenarios and other choices, then the options."""
    rows: Sequence[tuple[str, Sequence[str]]] = (
        ('controllers', controller_names()),
        ('architectures', ARCHITECTURES),
        *((f'{noun}s', packaged_names(noun)) for noun in CHOICES),
        ('modes', MODES),
    )
    for title, names in rows:
        print_note(f'{title}: {", ".join(names)}')
    print()
    print_table(controller_options_table())


def controller_options_table() -> TextTable:
    """Return the table of controllers' options, a row for all that declare the same option."""
    takers: dict[tuple[str, ...], list[str]] = {}
    for name in controller_names():
        try:
            options = controller_spec(name).options or {}
        except DdctError as error:  # a third party's controller that cannot be loaded
            options = {'-': Option(None, str(error))}
        for row in option_rows(options):
            takers.setdefault(row[:-1], []).append(name)
    table = TextTable(
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
