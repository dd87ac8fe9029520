# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommands of `campaign` for a campaign's folder: `replay` one row, `show` all results."""

import argparse
from functools import partial
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import add_layout_options
from ddct_plant.files.output_file import (
    STDOUT,
    require_one_for_stdout,
    require_picture,
    require_place,
)
from ddct_plant.program.command_line import ProgramParser, complain

_REPLAY = 'ddct campaign replay'
_PAGE = 'report.html'
_REPLAY_EPILOG = """\
examples:
  ddct campaign replay campaigns/wear --index 17 --out runs/again              through the graph
  ddct campaign replay campaigns/wear --index 17 --out runs/again --headless

The bag is RUN/<controller>/<controller>_0.mcap. The exit code is 0 only if the scores of the bag
are those of the row: of a serial row to the last bit, of a vectorised one to 1e-9 relative.
"""


def add_parsers(subparsers: 'argparse._SubParsersAction[ProgramParser]') -> None:
    """Add `replay` and `show` to the subcommands of `campaign`."""
    replay = subparsers.add_parser(
        'replay',
        help='make the bag of a row',
        description='`campaign replay`: the bag of one row, and whether its scores are those of '
        'the row.',
        epilog=_REPLAY_EPILOG,
    )
    show = subparsers.add_parser(
        'show',
        help='tables and page of a campaign',
        description='`campaign show`: what came out of a campaign, in the terminal and as a page.',
        epilog=_show_epilog(),
    )
    for parser, run in ((replay, _replay), (show, _show)):
        parser.add_argument('folder', metavar='DIR', type=Path, help='the folder of a campaign')
        parser.set_defaults(run=run)
    replay.add_argument('--index', type=int, metavar='I', required=True, help='of the row')
    replay.add_argument('--out', type=Path, metavar='RUN', required=True, help='for the bag')
    replay.add_argument('--overwrite', action='store_true', help='replace an earlier result')
    replay.add_argument('--json', metavar='FILE', help="write what was found; '-' is stdout")
    add_layout_options(replay)
    show.add_argument('--json', metavar='FILE', help="write summary.json to FILE; '-': stdout")
    show.add_argument('--csv', metavar='FILE', help="write the rows as CSV to FILE; '-': stdout")
    show.add_argument(
        '--figure', metavar='FILE', help='draw the distributions: a .png, .svg or .html file'
    )


def _show_epilog() -> str:
    return f"""\
examples:
  ddct campaign show campaigns/wear                      tables, and report.html anew
  ddct campaign show campaigns/wear --json summary.json  also the summary; '-' is standard output
  ddct campaign show campaigns/wear --csv rows.csv       also every row as CSV
  ddct campaign show campaigns/wear --figure wear.png    also the distributions of the metrics

Writes summary.json and report.html into DIR.

P5, P50, P95: {shell.RULES['quantiles']}

CVaR: {shell.RULES['CVaR']}
"""


def _replay(options: argparse.Namespace) -> int:
    require_place('--json', options.json)
    found = shell.replay_row(
        options.folder,
        options.index,
        options.out,
        shell.run_with_progress,
        partial(complain, _REPLAY),
        layout=options.layout,
        overwrite=options.overwrite,
    )
    if found.kept.scores.valid and options.json != STDOUT:
        print(found.kept.path.parent, flush=True)
    if options.json:
        shell.write_json(options.json, found.document)
    for line in found.differences:
        complain(_REPLAY, f'run {options.index}: {line}')
    if not found.differences:
        complain(_REPLAY, f'run {options.index}: {found.compared}')
    return 1 if found.differences else 0


def _show(options: argparse.Namespace) -> int:
    require_one_for_stdout(options.json, options.csv)
    for option in ('json', 'csv'):
        require_place(f'--{option}', getattr(options, option))
    require_picture('--figure', options.figure)
    summary = shell.show_campaign(
        options.folder, json=options.json, csv=options.csv, figure=options.figure
    )
    if STDOUT not in (options.json, options.csv):
        shell.print_campaign(summary, options.folder)
        print(options.folder / _PAGE)
    return 0
