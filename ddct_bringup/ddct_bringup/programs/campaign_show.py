"""`campaign show`: what came out of a campaign, in the terminal and as a page."""

import argparse
from pathlib import Path
from textwrap import fill

import pyarrow as pa
import pyarrow.csv as arrow_csv

from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign_report.folder import PAGE, SUMMARY, read_table, write_campaign_page
from ddct_bringup.campaign_report.words import RULES, replay_command, summary_tables
from ddct_plant.base.errors import DdctError, printable
from ddct_plant.files.output_file import STDOUT, require_place, write_json, write_text
from ddct_plant.program.command_line import ProgramParser
from ddct_plant.program.table import print_tables

_EPILOG = f"""\
examples:
  ddct campaign show campaigns/wear                      tables, and {PAGE} anew
  ddct campaign show campaigns/wear --json summary.json  also the summary; '-' is standard output
  ddct campaign show campaigns/wear --csv rows.csv       also every row as CSV

Writes {SUMMARY} and {PAGE} into DIR.
{fill(f'CVaR: {RULES["CVaR"]} {RULES["rank"]}', 96)}
"""


def add_parser(subparsers: 'argparse._SubParsersAction[ProgramParser]') -> None:
    """Add `show` to the subcommands of `campaign`."""
    parser = subparsers.add_parser(
        'show', help='tables and page of a campaign', description=__doc__, epilog=_EPILOG
    )
    parser.add_argument('folder', metavar='DIR', type=Path, help='the folder of a campaign')
    parser.add_argument('--json', metavar='FILE', help=f"write {SUMMARY} to FILE; '-': stdout")
    parser.add_argument('--csv', metavar='FILE', help="write the rows as CSV to FILE; '-': stdout")
    parser.set_defaults(run=_show)


def _show(options: argparse.Namespace) -> int:
    if options.json == STDOUT and options.csv == STDOUT:
        raise DdctError('--json - and --csv - both want standard output: give one a file')
    for option in ('json', 'csv'):
        require_place(f'--{option}', getattr(options, option))
    summary = write_campaign_page(options.folder)
    if options.json:
        write_json(options.json, summary)
    if options.csv:
        write_text(options.csv, _csv(options.folder))
    if STDOUT not in (options.json, options.csv):
        print_tables(summary_tables(summary))
        for reason in dict.fromkeys(each['failed']['no_interval'] for each in summary['groups']):
            if reason:
                print(f'no interval: {reason}')
        print(f'the bag of a run: {replay_command(str(options.folder), "I")}')
        print(options.folder / PAGE)
    return 0


def _csv(folder: Path) -> str:
    """Return every row of a campaign, the control characters of its words made visible."""
    table = read_table(folder, Manifest.read(folder))
    for place, field in enumerate(table.schema):
        if pa.types.is_string(field.type):
            words = [printable(each) for each in table[field.name].to_pylist()]
            table = table.set_column(place, field, pa.array(words, field.type))
    sink = pa.BufferOutputStream()
    arrow_csv.write_csv(table, sink)
    return sink.getvalue().to_pybytes().decode()
