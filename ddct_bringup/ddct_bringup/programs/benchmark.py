# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `benchmark`: judge controllers on fixed and on held-out cases."""

import argparse
import sys
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.benchmark.file_names import PAGE, RESULT
from ddct_bringup.programs.options.of_runs import add_workers_option
from ddct_plant.base.errors import DdctError, ParameterError, printable
from ddct_plant.base.options import Option
from ddct_plant.files.output_file import require_place
from ddct_plant.program.command_line import (
    ProgramParser,
    complain,
    run_program,
    show_and_write,
)
from ddct_plant.program.signals import stop_signals

PROGRAM = 'ddct benchmark'
_SECONDS_A_RUN = 0.1
"""Mean time of a run on one core."""
_SEED = Option(0, 'seed of a judge', at_least=0, at_most=2**31 - 1)

_EPILOG = f"""\
examples:
  ddct benchmark mine.yaml --out results/mine             a few minutes on two cores
  ddct benchmark mine.yaml --out results/try --quick      a tenth of the cases
  ddct benchmark a.py b.py ls8 --out results/three        each on its own held-out cases
  ddct benchmark mine.yaml --out results/city --car city7  in another car, or mycar.yaml
  ddct benchmark mine.yaml --out results/judged --seed 7  a judge chooses the held-out cases
  ddct verify results/mine                                whether a result comes out again
  ddct benchmark --packaged                               our controllers, without a run

The development cases are fixed in a release, which has our controllers' rows of them. The seed of
the held-out cases follows from the digests of controller and release; pi, ls8, hinf_sampled and
mpc_wear run beside yours. DIR/{PAGE} shows both side by side, DIR/{RESULT} has the same as JSON.
After an interruption the same command goes on with what is done. docs/use/benchmark.md has the
rules.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _benchmark, argv)


def _benchmark(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    require_place('--json', options.json)
    if options.packaged:
        return _show_packaged(options)
    if not options.controllers or not options.out:
        raise ParameterError('give controllers and --out, or --packaged')
    if options.seed is not None:
        _SEED.checked('--seed', options.seed)
    cases = shell.Cases.packaged(quick=options.quick, car=options.car)
    judged = _judged(options.controllers, cases)
    if judged is None:
        return 1
    if cases.car is not None:
        _say_what_runs(judged, cases)
    with stop_signals() as stops:
        result, _ = shell.judge_into(
            judged,
            cases,
            options.out,
            options.seed,
            workers=options.workers,
            stopped=lambda: bool(stops),
        )
    _show(result, options)
    return 1 if _complaints(result) else 0


def _judged(names: list[str], cases: 'shell.Cases') -> 'list[shell.Judged] | None':
    """Return the controllers; print a line for each that cannot be built, and return None."""
    found = []
    for name in names:
        try:
            found.append(shell.judged_of(name, cases))
        except DdctError as error:
            complain(PROGRAM, error)
    labels = [each.name for each in found]
    for label in dict.fromkeys(each for each in labels if labels.count(each) > 1):
        raise ParameterError(f'two controllers are called {label}: rename one')
    return found if len(found) == len(names) else None


def _say_what_runs(judged: 'list[shell.Judged]', cases: 'shell.Cases') -> None:
    """Print the expected time with a car, of which the release has no rows."""
    controllers = sum(len(cases.with_beside(each.chosen)) for each in judged)
    runs = 2 * controllers * cases.planned.cases
    print(
        f'{PROGRAM}: the release has no rows of {printable(cases.car)}, so '
        f'{", ".join(cases.beside)} run in the development cases too: {runs} runs, about '
        f'{max(1, round(runs * _SECONDS_A_RUN / 120))} min on two cores',
        file=sys.stderr,
        flush=True,
    )


def _complaints(result: 'shell.Result') -> bool:
    """Print a line for each controller that has no result; return whether there is one."""
    found = False
    for judged in result.controllers:
        name = judged.controller
        if judged.error:
            complain(PROGRAM, f'{name}: {judged.error}')
            found = True
        elif judged.held_out and not judged.held_out.group(name).states:
            reason = judged.held_out.group(name).reasons[0].reason
            complain(PROGRAM, f'{name}: every held-out run is invalid, such as: {reason}')
            found = True
    return found


def _show(result: 'shell.Result', options: argparse.Namespace) -> None:
    def show() -> None:
        times = shell.read_update_times(options.out)
        shell.print_document(shell.benchmark_document(result, times))
        print(options.out / PAGE, flush=True)

    show_and_write(options.json, shell.document_of(result, options.out), show)


def _show_packaged(options: argparse.Namespace) -> int:
    """Print or write the figures of the packaged controllers; they come with the release."""
    if (
        options.controllers
        or options.out
        or options.quick
        or options.car
        or options.seed is not None
    ):
        raise ParameterError('--packaged runs nothing: give it alone, or with --json')
    tables = shell.packaged_tables()
    show_and_write(
        options.json,
        shell.packaged_written(tables),
        lambda: shell.print_document(shell.packaged_document(tables)),
    )
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Judge controllers on fixed cases and on held-out ones, headless.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        'controllers', nargs='*', metavar='NAME|FILE', help='a controller or a controller file'
    )
    parser.add_argument('--out', type=Path, metavar='DIR', help='folder for it')
    parser.add_argument(
        '--car', metavar='NAME|FILE', help='car of all cases; default: those of the scenarios'
    )
    parser.add_argument(
        '--packaged', action='store_true', help="our controllers' figures, out of the release"
    )
    parser.add_argument('--quick', action='store_true', help='a tenth of the cases')
    parser.add_argument(
        '--seed', type=int, metavar='N', help='held-out cases of a judge; the result has a mark'
    )
    add_workers_option(parser)
    parser.add_argument('--json', metavar='FILE', help="write the result; '-' is standard output")
    return parser


if __name__ == '__main__':
    sys.exit(main())
