"""`campaign replay`: the bag of one row, and whether its scores are those of the row."""

import argparse
import sys
from pathlib import Path
from typing import Any

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.campaign.columns import (
    COMPARED,
    PATH,
    VECTORISED_RTOL,
    differences,
    read_row,
)
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.manifest import Manifest, code_digest
from ddct_bringup.campaign.rows import SERIAL, result_row
from ddct_bringup.run.execution import run_with_progress
from ddct_bringup.run.folder_lock import run_folder
from ddct_bringup.run.options import add_layout_options
from ddct_bringup.run.output_folder import StagedFolder
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scoring import Entry, score_recording
from ddct_bringup.verdict.limits import Limits, add_limits_option, load_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import require_place, write_json
from ddct_plant.program.command_line import ProgramParser, complain

PROGRAM = 'ddct campaign replay'
_EPILOG = """\
examples:
  ddct campaign replay campaigns/wear --index 17 --out runs/again              through the graph
  ddct campaign replay campaigns/wear --index 17 --out runs/again --headless

The bag is RUN/<controller>/<controller>_0.mcap. The exit code is 0 only if the scores of the bag
are those of the row: of a serial row to the last bit, of a vectorised one to 1e-9 relative.
"""


def add_parser(subparsers: 'argparse._SubParsersAction[ProgramParser]') -> None:
    """Add `replay` to the subcommands of `campaign`."""
    parser = subparsers.add_parser(
        'replay', help='make the bag of a row', description=__doc__, epilog=_EPILOG
    )
    parser.add_argument('folder', metavar='DIR', type=Path, help='the folder of a campaign')
    parser.add_argument('--index', type=int, metavar='I', required=True, help='of the row')
    parser.add_argument('--out', type=Path, metavar='RUN', required=True, help='for the bag')
    parser.add_argument('--overwrite', action='store_true', help='replace an earlier result')
    parser.add_argument('--json', metavar='FILE', help="write what was found; '-' is stdout")
    add_layout_options(parser)
    add_limits_option(parser)
    parser.set_defaults(run=_replay)


def _replay(options: argparse.Namespace) -> int:
    require_place('--json', options.json)
    manifest = Manifest.read(options.folder)
    limits = load_limits(options.limits)
    manifest.require_limits(limits, options.folder)
    campaign = manifest.campaign(options.folder)
    row = read_row(options.folder / RESULTS, options.index)
    if manifest.code_digest != code_digest():
        complain(PROGRAM, f'the campaign is of {manifest.code}, this is another code')
    run = campaign.run(options.index)
    plan = RunPlan(run.settings, campaign.chosen(options.index), options.layout)
    with run_folder(options.out, plan.name, overwrite=options.overwrite) as folder:
        entry = _made_again(plan, folder, row, limits)
    found = differences(row, result_row(entry, run.varied))
    if options.json:
        report = {'index': options.index, 'path': row[PATH], 'differences': found}
        write_json(options.json, report)
    for line in found:
        complain(PROGRAM, f'run {options.index}: {line}')
    if not found:
        how = 'bit for bit' if row[PATH] == SERIAL else f'to {VECTORISED_RTOL:g}'
        print(
            f'{PROGRAM}: run {options.index}: its {len(COMPARED)} figures and words are those of '
            f'the row, {how}',
            file=sys.stderr,
        )
    return 1 if found else 0


def _made_again(plan: RunPlan, folder: StagedFolder, row: dict[str, Any], limits: Limits) -> Entry:
    """Carry out the run of a row and return its scores; a valid one gets its final name."""
    try:
        run_with_progress(plan, folder.path)
    except DdctError as error:
        if row['valid'] or not row['reason']:
            raise
        raise DdctError(f'it fails as its row says ({row["reason"]}): {error}') from error
    entry = score_recording(read_bag(folder.path), plan.name, limits)
    if entry['valid']:
        folder.commit()
        print(folder.final, flush=True)
    return entry
