# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `thesis`: the numbers, figures and studies of the thesis, made again."""

from ddct_bringup.api import shell
from ddct_plant.program.command_line import LateSubcommand, ProgramParser, run_subcommands

PROGRAM = 'ddct thesis'
_COMMANDS = {
    'numbers': LateSubcommand("the thesis's numbers beside ours", lambda: shell.numbers_command),
    'figures': LateSubcommand(
        'the figures of the thesis, and a page that shows them', lambda: shell.figures_command
    ),
    'studies': LateSubcommand(
        'studies of the predictive controllers', lambda: shell.studies_command
    ),
}

_DESCRIPTION = 'Compute what the thesis prints, and hold it against the print.'
_EPILOG = """\
examples:
  ddct thesis numbers                     every printed number beside ours
  ddct thesis figures --out figures       the thesis's figures, drawn again
  ddct thesis studies                     what decides how the predictive controllers fare

Each of them has its own --help."""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    parser = ProgramParser(prog=PROGRAM, description=_DESCRIPTION, epilog=_EPILOG)
    return run_subcommands(parser, _COMMANDS, argv, metavar='WHAT')


if __name__ == '__main__':
    raise SystemExit(main())
