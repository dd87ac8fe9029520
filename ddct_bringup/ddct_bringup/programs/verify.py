# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `verify`: check the files of a result, make everything again, and compare."""

import argparse
import sys
from pathlib import Path

from ddct_bringup import verification
from ddct_bringup.programs.options.of_runs import add_workers_option
from ddct_bringup.verification.states import (
    BOUND,
    DIFFERENT,
    NOT_REPEATED,
    SAME_BITS,
    SAME_WITHIN,
)
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

_EPILOG = f"""\
examples:
  ddct verify runs/demo                   the runs of compare or bringup
  ddct verify campaigns/wear --workers 2  a campaign: every row again
  ddct verify runs/demo --json -          the result as JSON

First every file is compared with its digest in manifest.json. Then everything is made again in a
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
    found = verification.verified_results(options.path, options.workers)

    def show() -> None:
        for each in found.results:
            verification.print_verification(each)

    show_and_write(options.json, found.document, show)
    for line in (line for each in found.results for line in verification.complaints(each)):
        complain(PROGRAM, line)
    return _CODES[found.state]


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Check that a result is as its program wrote it, and that it comes out again.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        'path', metavar='PATH', type=Path, help='a folder with manifest.json, or one around such'
    )
    add_workers_option(parser)
    parser.add_argument('--json', metavar='FILE', help="write the result; '-' is standard output")
    return parser


if __name__ == '__main__':
    sys.exit(main())
