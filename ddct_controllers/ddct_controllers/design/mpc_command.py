"""Subcommand `design mpc`: what decides how the predictive controllers fare."""

import argparse
import sys
from typing import Any

from ddct_controllers.design.mpc_export import (
    add_options,
    require_no_export_options,
    run_export,
)
from ddct_controllers.design.study import Study, all_studies
from ddct_plant.checks import require_choice
from ddct_plant.errors import DdctError
from ddct_plant.output_file import STDOUT, write_json, write_text
from ddct_plant.page_tables import fill_tables, marked_tables, read_page
from ddct_plant.table import print_table

_DESCRIPTION = """\
Chapter 4 and what it leaves to future work: closed-loop studies of the predictive
controllers in the frozen thesis scenario, each a table."""
_EPILOG = """\
examples:
  design mpc                              every study
  design mpc --study readings             MPC1-3 under the readings of Table 4.1
  design mpc --study wear --json wear.json
  design mpc --write-doc docs/mpc.md      fill in the tables that the page marks
  design mpc --export control_unit --controller mpc_offset_free

The studies need the closed loop of ddct_bringup."""


def add_parser(subparsers: Any) -> None:
    """Add `mpc` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'mpc',
        help='studies of the predictive controllers',
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument('--study', action='append', metavar='NAME', help='may be repeated')
    parser.add_argument('--json', metavar='FILE', help='write the tables; - is standard output')
    parser.add_argument('--write-doc', metavar='FILE', help='fill in the tables of the page FILE')
    add_options(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Make the tables, print them or write them where asked for, and return the exit code."""
    if options.export:
        return run_export(options)
    require_no_export_options(options)
    page = read_page(options.write_doc) if options.write_doc else ''
    functions = all_studies()
    if not functions:
        raise DdctError('no study is installed: they need ddct_bringup, build the workspace')
    names = options.study or marked_tables(page, 'mpc') or list(functions)
    for name in names:
        require_choice('study', name, list(functions))
    studies: dict[str, Study] = {}
    for name in names:
        print(f'design mpc: {name} ...', file=sys.stderr)
        studies[name] = functions[name]()
        if options.json != STDOUT:
            _print(studies[name])
    if options.json:
        write_json(options.json, {name: study.as_dict() for name, study in studies.items()})
    if options.write_doc:
        write_text(options.write_doc, fill_tables(page, 'mpc', studies))
    return 0


def _print(study: Study) -> None:
    print_table(study.title, study.headers, study.rows)
    for remark in study.remarks:
        print(f'  {remark}')
    if study.remarks:
        print()
