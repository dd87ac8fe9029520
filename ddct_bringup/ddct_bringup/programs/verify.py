# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `verify`: check the digests of a result, run everything again, and compare."""

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ddct_bringup.digests.digest_file import DIGESTS, read_digests
from ddct_bringup.programs.options.of_runs import add_limits_option
from ddct_bringup.run.output_folder import locked_folders
from ddct_bringup.verdict.limits import load_limits
from ddct_bringup.verification.comparison import BOUND
from ddct_bringup.verification.folder import (
    Verification,
    entry_of,
    folders_with_digests,
    verified_folder,
)
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.text import complaints, print_verification
from ddct_plant.files.output_file import require_place
from ddct_plant.program.command_line import (
    ProgramParser,
    complain,
    run_program,
    show_and_write,
)

PROGRAM = 'ddct verify'

_EPILOG = f"""\
examples:
  ddct verify runs/demo                   the runs of compare or bringup
  ddct verify campaigns/wear --workers 2  a campaign: every row again
  ddct verify runs/mine --files ~/mine    its controller files are in that folder now
  ddct verify runs/demo --json -          the result as JSON

First every file is compared with its digest in {DIGESTS}. Then all runs are executed again,
headless, and compared: to the last bit where code, versions and processor are those of the result,
else to {BOUND:g} of the largest value. Of runs in real time only digests and scores are checked.
Nothing in PATH is changed. The exit code is 0 only if all is the same.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _verify, argv)


def _verify(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    require_place('--json', options.json)
    limits = load_limits(options.limits)
    found = []
    for folder in folders_with_digests(options.path):
        with locked_folders(folder, shared=True):
            digests = read_digests(folder)
            request = VerificationRequest(folder, digests, limits, options.files, options.workers)
            found.append(verified_folder(request))
    show_and_write(options.json, _document(found), lambda: _show(found))
    for line in (line for each in found for line in complaints(each)):
        complain(PROGRAM, line)
    return 0 if all(each.same for each in found) else 1


def _show(found: Sequence[Verification]) -> None:
    for each in found:
        print_verification(each)


def _document(found: Sequence[Verification]) -> Mapping[str, Any]:
    """Return the results as JSON; with several folders, paths and runs begin with the folder."""
    if len(found) == 1:
        return entry_of(found[0])
    folders = [dict(entry_of(each)) for each in found]
    files, runs = [], []
    for each in folders:
        name = each['folder']
        files += [{**file, 'path': f'{name}/{file["path"]}'} for file in each.pop('files')]
        runs += [{**run, 'run': f'{name}: {run["run"]}'} for run in each.pop('runs')]
    same = all(each.same for each in found)
    return {'same': same, 'files': files, 'runs': runs, 'folders': folders}


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Check that a result is as its program wrote it, and that it comes out again.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        'path', metavar='PATH', type=Path, help=f'a folder with {DIGESTS}, or one around such'
    )
    parser.add_argument(
        '--files',
        metavar='DIR',
        type=Path,
        help='folder of the controller, handover and scenario files of the result, if moved',
    )
    parser.add_argument(
        '--workers', type=int, metavar='N', help='processes of a campaign; default: one per core'
    )
    parser.add_argument('--json', metavar='FILE', help="write the result; '-' is standard output")
    add_limits_option(parser)
    return parser


if __name__ == '__main__':
    sys.exit(main())
