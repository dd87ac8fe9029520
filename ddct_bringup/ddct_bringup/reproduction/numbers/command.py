# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `thesis numbers`: comparison of every printed number with a computed one."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from ddct_bringup.reproduction.numbers.gate import GateRow, NumbersDocument, judge
from ddct_bringup.reproduction.numbers.gate_tables import (
    chapter_tables,
    misses_table,
    page_tables,
)
from ddct_bringup.reproduction.numbers.number_files import thesis_numbers
from ddct_bringup.reproduction.numbers.thesis_number import ThesisNumber, Value
from ddct_bringup.reproduction.values.closed_loop_values import closed_loop_values
from ddct_bringup.reproduction.values.controller_values import predictive_values
from ddct_bringup.reproduction.values.h_infinity_values import h_infinity_values
from ddct_bringup.reproduction.values.loop_shaping_values import loop_shaping_values
from ddct_bringup.reproduction.values.plant_values import plant_values
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.csv_table import csv_text
from ddct_plant.files.json_records import to_json, write_json
from ddct_plant.files.output_file import STDOUT, require_one_for_stdout, require_place, write_text
from ddct_plant.program.command_line import complain, show_and_write
from ddct_plant.program.printed_table import print_tables

Source = Callable[[], Mapping[str, Value | None]]
"""Function that returns values by the ids of the gate's files, None for an undefined one."""
SOURCES: Mapping[str, Source] = {
    'plant': plant_values,
    'loop shaping': loop_shaping_values,
    'H-infinity': h_infinity_values,
    'predictive control': predictive_values,
    'closed loop': closed_loop_values,
}
"""Functions that compute the numbers of the gate's files, by chapter."""
_DESCRIPTION = """\
Compute every number that the thesis prints and hold it against the print:
reproduced, erratum (the thesis's own numbers lead to another value), calibrated
(fitted to), predicted (hit or miss), given (an input) or not_reproducible (a result
whose inputs are not printed)."""
_EPILOG = """\
examples:
  ddct thesis numbers
  ddct thesis numbers --section 'Table 5.2'
  ddct thesis numbers --json numbers.json
  ddct thesis numbers --json -                  as JSON on standard output, alone
  ddct thesis numbers --csv numbers.csv         a row per number, for a spreadsheet

The exit code is 0 when every claim holds. A reproduced number is within its tolerance.
A calibrated number is too, or is listed as a miss. An erratum differs from the print
and has the value given as ours. A prediction may miss, but must have a value."""
_SHOWN_COMPLAINTS = 3


def add_parser(subparsers: Any) -> None:
    """Add `numbers` to the subcommands of `thesis`."""
    parser = subparsers.add_parser(
        'numbers',
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--section', metavar='S', help="only that chapter, section or table: 5, 3.2, 'Table 5.2'"
    )
    parser.add_argument('--json', metavar='FILE', help='write all numbers; - is standard output')
    parser.add_argument('--csv', metavar='FILE', help='the same as CSV; - is standard output')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print and write the tables as requested; raise DdctError when a claim of the gate fails."""
    require_one_for_stdout(options.json, options.csv)
    require_place('--json', options.json)
    require_place('--csv', options.csv)
    every = thesis_numbers()
    chosen = chosen_numbers(every, options.section)
    judged = judge(every, compute(SOURCES, partial(complain, 'ddct thesis numbers')))
    rows = [row for row in judged if row.number in chosen]
    numbers = [row.entry for row in rows]
    tables = {name: table.written for name, table in page_tables(rows).items()}
    document = NumbersDocument(numbers, tables)
    if options.csv:
        cells = [list(to_json(each).values()) for each in numbers]
        write_text(options.csv, csv_text(to_json(numbers[0]), cells))
    if options.csv != STDOUT:
        show_and_write(options.json, document, lambda: _print(rows, every=not options.section))
    elif options.json:
        write_json(options.json, document)
    require_all(rows)
    return 0


def compute(
    sources: Mapping[str, Source], progress: Callable[[str], None] = lambda name: None
) -> dict[str, Value | None]:
    """
    Return the values of all sources; `progress` is called with the name of each one first.

    Raise ParameterError when two of them compute the same number.
    """
    values: dict[str, Value | None] = {}
    for name, source in sources.items():
        progress(name)
        found = source()
        twice = sorted(values.keys() & found.keys())
        if twice:
            raise ParameterError(
                f'thesis numbers of {name}: computed already: {", ".join(twice)}', key=twice[0]
            )
        values.update(found)
    return values


def _print(rows: Sequence[GateRow], *, every: bool) -> None:
    tables = page_tables(rows)
    counts = ('summary', 'facts') if every else ()
    last = (misses_table(rows), *(tables[name] for name in ('errata', *counts)))
    shown = (*chapter_tables(rows, reasons=False).values(), *last)
    print_tables(table for table in shown if table.rows)


def chosen_numbers(numbers: Sequence[ThesisNumber], section: str | None) -> list[ThesisNumber]:
    """
    Return the numbers of a chapter (`5`), section (`3.2`, with its parts) or table (`Table 5.2`).

    Without `section` these are all. Raise ParameterError when there are none.
    """
    found = [each for each in numbers if section is None or section in _names_of(each)]
    if section is not None and not found:
        known = dict.fromkeys(each.section for each in numbers)
        raise ParameterError(
            f'--section {section}: no printed number there; the sections are ' + '; '.join(known),
            key=section,
        )
    return found


def _names_of(number: ThesisNumber) -> set[str]:
    """Return the names of all parts of the thesis that a number stands in."""
    place, _, table = number.section.partition(', ')
    parts = place.split('.')
    upper = {'.'.join(parts[: count + 1]) for count in range(len(parts))}
    return {*upper, number.section, table} - {''}


def require_all(rows: Sequence[GateRow]) -> None:
    """Raise DdctError when a claim of the gate fails."""
    broken = [
        f'{row.number.section}, {row.number.item}: {row.complaint}'
        for row in rows
        if row.complaint
    ]
    if broken:
        more = len(broken) - _SHOWN_COMPLAINTS
        rest = f'; and {more} more' if more > 0 else ''
        raise DdctError(
            f'a claim of the list does not hold: {"; ".join(broken[:_SHOWN_COMPLAINTS])}{rest}'
        )
