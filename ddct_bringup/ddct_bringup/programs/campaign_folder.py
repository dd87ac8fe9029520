# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommands of `campaign` for a campaign's folder: `replay` one row, `show` all results."""

import argparse
import sys
from pathlib import Path
from textwrap import fill
from typing import Any

import pyarrow as pa
import pyarrow.csv as arrow_csv

from ddct_bringup.campaign.columns import (
    PATH,
    SEED,
    VECTORISED_RTOL,
    compared_in,
    differences,
    read_row,
)
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign.rows import SERIAL, result_row
from ddct_bringup.campaign_report.distributions_figure import write_distributions
from ddct_bringup.campaign_report.folder import PAGE, SUMMARY, scenario_of, write_campaign_page
from ddct_bringup.campaign_report.printed_summary import print_summary
from ddct_bringup.campaign_report.reading import read_table, require_as_written, results_of
from ddct_bringup.campaign_report.texts import RULES
from ddct_bringup.digests.code import code_digest
from ddct_bringup.digests.writing import keep_digests
from ddct_bringup.run.execution import run_with_progress
from ddct_bringup.run.options import add_layout_options
from ddct_bringup.run.output_folder import StagedFolder, run_folder
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import run_and_score
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits, add_limits_option, load_limits
from ddct_plant.base.errors import DdctError, printable
from ddct_plant.files.csv_table import plain_cell
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import (
    STDOUT,
    require_one_for_stdout,
    require_picture,
    require_place,
    write_text,
)
from ddct_plant.program.command_line import ProgramParser, complain

_REPLAY = 'ddct campaign replay'
_REPLAY_EPILOG = """\
examples:
  ddct campaign replay campaigns/wear --index 17 --out runs/again              through the graph
  ddct campaign replay campaigns/wear --index 17 --out runs/again --headless

The bag is RUN/<controller>/<controller>_0.mcap. The exit code is 0 only if the scores of the bag
are those of the row: of a serial row to the last bit, of a vectorised one to 1e-9 relative.
"""
_SHOW_EPILOG = f"""\
examples:
  ddct campaign show campaigns/wear                      tables, and {PAGE} anew
  ddct campaign show campaigns/wear --json summary.json  also the summary; '-' is standard output
  ddct campaign show campaigns/wear --csv rows.csv       also every row as CSV
  ddct campaign show campaigns/wear --figure wear.png    also the distributions of the metrics

Writes {SUMMARY} and {PAGE} into DIR.
{fill(f'P5, P50, P95: {RULES["quantiles"]}', 96)}
{fill(f'CVaR: {RULES["CVaR"]}', 96)}
"""


def add_parser(subparsers: 'argparse._SubParsersAction[ProgramParser]') -> None:
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
        epilog=_SHOW_EPILOG,
    )
    for parser, run in ((replay, _replay), (show, _show)):
        parser.add_argument('folder', metavar='DIR', type=Path, help='the folder of a campaign')
        parser.set_defaults(run=run)
    replay.add_argument('--index', type=int, metavar='I', required=True, help='of the row')
    replay.add_argument('--out', type=Path, metavar='RUN', required=True, help='for the bag')
    replay.add_argument('--overwrite', action='store_true', help='replace an earlier result')
    replay.add_argument('--json', metavar='FILE', help="write what was found; '-' is stdout")
    add_layout_options(replay)
    add_limits_option(replay)
    show.add_argument('--json', metavar='FILE', help=f"write {SUMMARY} to FILE; '-': stdout")
    show.add_argument('--csv', metavar='FILE', help="write the rows as CSV to FILE; '-': stdout")
    show.add_argument(
        '--figure', metavar='FILE', help='draw the distributions as FILE.png or FILE.svg'
    )


def _replay(options: argparse.Namespace) -> int:
    require_place('--json', options.json)
    manifest = Manifest.read(options.folder)
    limits = load_limits(options.limits)
    manifest.require_limits(limits, options.folder)
    campaign = manifest.campaign(options.folder)
    require_as_written(options.folder)
    row = read_row(options.folder / RESULTS, options.index, manifest.runs)
    if manifest.code_digest != code_digest():
        complain(_REPLAY, f'the campaign is of {manifest.origin.short}, this is another code')
    run = campaign.run(options.index)
    plan = RunPlan(run.settings, campaign.chosen(options.index), options.layout)
    with run_folder(options.out, plan.name, overwrite=options.overwrite) as folder:
        scored = _made_again(plan, folder, row, limits)
    found = differences(row, {SEED: run.settings.seed, **result_row(scored, run.varied)})
    if options.json:
        report = {'index': options.index, 'path': row[PATH], 'differences': found}
        write_json(options.json, report)
    for line in found:
        complain(_REPLAY, f'run {options.index}: {line}')
    if not found:
        how = 'bit for bit' if row[PATH] == SERIAL else f'to {VECTORISED_RTOL:g}'
        print(
            f'{_REPLAY}: run {options.index}: its {len(compared_in(row))} figures and words are '
            f'those of the row, {how}',
            file=sys.stderr,
        )
    return 1 if found else 0


def _made_again(
    plan: RunPlan, folder: StagedFolder, row: dict[str, Any], limits: Limits
) -> ScoredRun:
    """Execute the run of a row and return its scores; commit the folder of a valid run."""
    try:
        scored = run_and_score(plan, folder.path, limits, run_with_progress).scores
    except DdctError as error:
        if row['valid'] or not row['reason']:
            raise
        raise DdctError(f'it fails as its row says ({row["reason"]}): {error}') from error
    if scored.valid:
        folder.commit()
        print(folder.final, flush=True)
    return scored


def _show(options: argparse.Namespace) -> int:
    require_one_for_stdout(options.json, options.csv)
    for option in ('json', 'csv'):
        require_place(f'--{option}', getattr(options, option))
    require_picture('--figure', options.figure)
    summary = write_campaign_page(options.folder)
    if options.json:
        write_json(options.json, summary)
    if options.csv:
        write_text(options.csv, _csv(options.folder))
    if options.figure:
        manifest = Manifest.read(options.folder)
        results = results_of(manifest, read_table(options.folder, manifest))
        write_distributions(results, scenario_of(manifest), Path(options.figure))
    written = (options.json, options.csv, options.figure)
    keep_digests(file for file in written if file not in (None, STDOUT))
    if STDOUT not in (options.json, options.csv):
        print_summary(summary, options.folder)
        print(options.folder / PAGE)
    return 0


def _csv(folder: Path) -> str:
    """Return every row of a campaign as CSV, with control characters in its texts escaped."""
    table = read_table(folder, Manifest.read(folder))
    for place, field in enumerate(table.schema):
        if pa.types.is_string(field.type):
            words = [plain_cell(printable(each)) for each in table[field.name].to_pylist()]
            table = table.set_column(place, field, pa.array(words, field.type))
    sink = pa.BufferOutputStream()
    arrow_csv.write_csv(table, sink)
    return sink.getvalue().to_pybytes().decode()
