"""Subcommand `reproduce numbers`: every number that the thesis prints, beside ours."""

import argparse
import sys
from collections.abc import Sequence
from typing import Any

from ddct_bringup.reproduction.numbers.gate import GateRow, judge
from ddct_bringup.reproduction.numbers.gate_tables import (
    chapter_tables,
    errata_table,
    facts_table,
    page_tables,
    summary_table,
)
from ddct_bringup.reproduction.numbers.number_file import thesis_numbers
from ddct_bringup.reproduction.numbers.sources import SOURCES, compute
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import STDOUT, write_json, write_text
from ddct_plant.program.page_tables import fill_tables, read_page
from ddct_plant.program.table import print_table

_DESCRIPTION = """\
Compute every number that the thesis prints and hold it against the print:
reproduced, erratum (the thesis's own numbers lead to another value), calibrated
(fitted to), predicted (hit or miss), given (an input) or not_reproducible (a result
whose inputs are not printed)."""
_EPILOG = """\
examples:
  reproduce numbers
  reproduce numbers --json numbers.json
  reproduce numbers --json -                  as JSON on standard output, alone
  reproduce numbers --write-doc docs/thesis_gate.md

The exit code is 0 when every claim holds: what is called reproduced is within its
tolerance, what is called calibrated is too or is listed as a miss, and every erratum
differs from the print and is the value given as ours. A prediction may miss, but not
be without a value."""
_SHOWN_COMPLAINTS = 3


def add_parser(subparsers: Any) -> None:
    """Add `numbers` to the subcommands of `reproduce`."""
    parser = subparsers.add_parser(
        'numbers',
        help="the thesis's numbers beside ours",
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument('--json', metavar='FILE', help='write all numbers; - is standard output')
    parser.add_argument('--write-doc', metavar='FILE', help='fill in the tables of the page FILE')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the tables, write what is asked for; raise DdctError when the gate does not hold."""
    page = read_page(options.write_doc) if options.write_doc else ''
    rows = judge(thesis_numbers(), compute(SOURCES, _progress))
    if options.json != STDOUT:
        _print(rows)
    if options.json:
        write_json(options.json, {'numbers': [row.as_dict() for row in rows]})
    _require_all(rows)
    if options.write_doc:
        write_text(options.write_doc, fill_tables(page, 'numbers', page_tables(rows)))
    return 0


def _progress(name: str) -> None:
    print(f'reproduce numbers: {name}', file=sys.stderr, flush=True)


def _print(rows: Sequence[GateRow]) -> None:
    tables = chapter_tables(rows, reasons=False).values()
    for table in (*tables, errata_table(rows), summary_table(rows), facts_table(rows)):
        print_table(table)


def _require_all(rows: Sequence[GateRow]) -> None:
    broken = [
        f'{row.number.section}, {row.number.item}: {row.complaint}'
        for row in rows
        if row.complaint
    ]
    if broken:
        more = len(broken) - _SHOWN_COMPLAINTS
        rest = f'; and {more} more' if more > 0 else ''
        raise DdctError(f'the gate does not hold: {"; ".join(broken[:_SHOWN_COMPLAINTS])}{rest}')
