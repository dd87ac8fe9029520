# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `tune`: search the options of a controller; writes the best as a file."""

import argparse
import sys
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import add_workers_option
from ddct_bringup.tuning.specification.packaged_specs import packaged_specs
from ddct_bringup.tuning.tuned_names import BEST, PAGE, RESULT
from ddct_plant.files.output_file import require_place
from ddct_plant.program.command_line import (
    ProgramParser,
    complain,
    run_program,
    show_and_write,
)
from ddct_plant.program.signals import stop_signals

PROGRAM = 'ddct tune'
_EPILOG = f"""\
examples:
  ddct tune --controller pi --spec pi_launches --out tuned/pi      a packaged specification
  ddct tune --controller mine.yaml --spec mine_tuning.yaml --out tuned/mine
  ddct tune --controller mine.yaml --spec mine_tuning.yaml --out tuned/mine --resume
  ddct tune --controller pi --spec pi_launches --car mycar.yaml --out tuned/mycar
  ddct compare --controllers pi,tuned/pi/{BEST} --scenario launch --headless --out runs/tuned

SPEC has the options with their ranges, objectives, constraints and cases: docs/use/tune.md.
DIR/{BEST} is the best as a controller file, DIR/front/ has the others of the front, DIR/{PAGE}
shows the front, what decides, convergence, and the figures on held-out cases; DIR/{RESULT} has the
same as JSON. After an interruption --resume computes what is missing, with the same result. It
needs Optuna: make setup EXTRAS=tune.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _tune, argv)


def _tune(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    require_place('--json', options.json)
    shell.require_optuna()
    with stop_signals() as stops:
        result = shell.tune_into(
            options.controller,
            options.spec,
            options.out,
            car=options.car,
            left_out=_say_left_out,
            workers=options.workers,
            resume=options.resume,
            stopped=lambda: bool(stops),
        )

    def show() -> None:
        shell.print_document(shell.tuning_document(result))
        print(options.out / BEST)
        print(options.out / PAGE, flush=True)

    show_and_write(options.json, result, show)
    return 0


def _say_left_out(scenario: str, reason: str) -> None:
    complain(PROGRAM, f'{scenario} is left out, since the car cannot drive it: {reason}')


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Search the options of a controller against objectives, headless.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--controller', required=True, metavar='NAME|FILE', help='a controller or its file'
    )
    parser.add_argument(
        '--spec',
        required=True,
        metavar='SPEC.yaml',
        help=f'what is searched and wanted; packaged: {", ".join(packaged_specs())}',
    )
    parser.add_argument(
        '--car',
        metavar='NAME|FILE',
        help='car of all cases, around which those are drawn; default: those of the scenarios',
    )
    parser.add_argument('--out', type=Path, metavar='DIR', required=True, help='folder for it')
    parser.add_argument('--resume', action='store_true', help='go on with the tuning in DIR')
    add_workers_option(parser)
    parser.add_argument('--json', metavar='FILE', help="write the result; '-' is standard output")
    return parser


if __name__ == '__main__':
    sys.exit(main())
