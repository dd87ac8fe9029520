# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `verify`: check the files of a result, make everything again, and compare."""

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ddct_bringup.manifest.manifest import MANIFEST
from ddct_bringup.programs.options.of_runs import add_workers_option
from ddct_bringup.run.output_folder import locked_folders
from ddct_bringup.verification.comparison import BOUND
from ddct_bringup.verification.folder import Verification, entry_of, results_in, verified
from ddct_bringup.verification.result import DIFFERENT, NOT_REPEATED, SAME_BITS, SAME_WITHIN
from ddct_bringup.verification.text import complaints, print_verification
from ddct_plant.files.output_file import require_place
from ddct_plant.program.command_line import (
    ProgramParser,
    complain,
    run_program,
    show_and_write,
)

PROGRAM = 'ddct verify'
_CODES = {SAME_BITS: 0, DIFFERENT: 1, SAME_WITHIN: 3, NOT_REPEATED: 3}
"""Exit codes by the state of the results."""
_WORST = (DIFFERENT, NOT_REPEATED, SAME_WITHIN)

_EPILOG = f"""\
examples:
  ddct verify runs/demo                   the runs of compare or bringup
  ddct verify campaigns/wear --workers 2  a campaign: every row again
  ddct verify runs/demo --json -          the result as JSON

First every file is compared with its digest in {MANIFEST}. Then everything is made again in a
scratch folder, headless, from the inputs in PATH, and compared file by file: to the last bit
where code, libraries and versions are those of the result, else to {BOUND:g} of each signal's
peak. Nothing in PATH is changed. The exit code is 0 where everything was made again and is equal,
3 where it is equal as far as it could be repeated (the last line says what could not), 1 where
something differs.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _verify, argv)


def _verify(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    require_place('--json', options.json)
    found = []
    for folder in results_in(options.path):
        with locked_folders(folder, shared=True):
            found.append(verified(folder, options.workers))
    show_and_write(options.json, _document(found), lambda: _show(found))
    for line in (line for each in found for line in complaints(each)):
        complain(PROGRAM, line)
    return _CODES[_state(found)]


def _state(found: Sequence[Verification]) -> str:
    states = {each.state for each in found}
    return next((each for each in _WORST if each in states), SAME_BITS)


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
    state = _state(found)
    same = state != DIFFERENT
    return {'same': same, 'state': state, 'files': files, 'runs': runs, 'folders': folders}


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Check that a result is as its program wrote it, and that it comes out again.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        'path', metavar='PATH', type=Path, help=f'a folder with {MANIFEST}, or one around such'
    )
    add_workers_option(parser)
    parser.add_argument('--json', metavar='FILE', help="write the result; '-' is standard output")
    return parser


if __name__ == '__main__':
    sys.exit(main())
