# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `sweep`: a short campaign over the values of a key: a table, a figure."""

import argparse
import sys
import time
from functools import partial
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import (
    ALL,
    add_controllers_option,
    add_limits_option,
    add_settings_options,
    settings_given,
)
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.output_file import (
    STDOUT,
    require_one_for_stdout,
    require_picture,
    require_place,
    write_text,
)
from ddct_plant.program.command_line import ProgramParser, complain, run_program

PROGRAM = 'ddct sweep'
_complain = partial(complain, PROGRAM)
_MOST_DRAWN = 2
_EPILOG = """\
examples:
  ddct sweep --over wear_gain=0.5:1.5:11 --controllers pi,ls8,mpc3 --figure wear.png
  ddct sweep --over vehicle.mass_kg=1200:2400:7 --controllers ls8,mine --scenario launch
  ddct sweep --over controllers.pi.proportional_gain=0.05,0.1,0.2 --controllers pi --json -
  ddct sweep --over wear_gain=0.5:1.5:11 --controllers pi --csv wear.csv
  ddct sweep --over wear_gain=0.6:1.4:9 --over load.slope_rad=0:0.1:5 --controllers pi,ls8
  ddct sweep --over wear_gain=0.5:1.5:11 --controllers pi --spec wear.yaml     then, as files:
  ddct campaign wear.yaml --out campaigns/wear

Runs are headless, on all cores, and judged as by `ddct score`. Values that belong together
move together, as with --set. A run that fails is a row with its reason, and the exit code is 1.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _sweep, argv)


def _sweep(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    if options.list:
        shell.print_choices()
        return 0
    if not options.over:
        raise ParameterError('--over is missing: give KEY=START:STOP:COUNT')
    metrics = shell.metrics_called('--metrics', options.metrics)
    require_one_for_stdout(options.json, options.csv)
    require_place('--json', options.json)
    require_place('--csv', options.csv)
    require_place('--spec', options.spec)
    if options.figure:
        _require_picture(options.figure, len(options.over))
    sweep = shell.planned_sweep(
        None if options.controllers == ALL else shell.controllers_of(options.controllers),
        [shell.axis_of(text) for text in options.over],
        shell.load_limits(options.limits),
        _complain,
        **settings_given(options),
    )
    for line in sweep.first.scenario.adjusted:
        _complain(f'at the first point {line}')
    if options.spec:
        write_text(options.spec, shell.dump_yaml(shell.specification_of(sweep)))
    started = time.perf_counter()
    with sweep.runs() as each:
        runs = list(shell.with_progress(each, len(sweep), f'{len(sweep)} runs'))
    what = '1 run' if len(runs) == 1 else f'{len(runs)} runs'
    _complain(f'{what} in {time.perf_counter() - started:.1f} s')
    if options.json:
        shell.write_json(options.json, shell.sweep_document(sweep, runs))
    if options.csv:
        write_text(options.csv, shell.table_csv(sweep.table(runs)))
    stream = sys.stderr if STDOUT in (options.json, options.csv) else sys.stdout
    shell.print_document(shell.sweep_shown(sweep, runs, metrics), stream)
    if options.figure:
        shell.write_chart(shell.sweep_chart(sweep, runs, metrics), Path(options.figure))
    failed = sum(not run.scores.valid for run in runs)
    if failed:
        _complain(f'{failed} of {len(runs)} runs are not valid: the lines above say why')
    return 1 if failed else 0


def _require_picture(target: str, keys: int) -> None:
    if keys > _MOST_DRAWN:
        raise ParameterError(
            f'--figure draws over one or two keys, not {keys}: leave it out, or an --over'
        )
    require_picture('--figure', target)


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Run controllers over the values of a key and compare their scores.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--over',
        action='append',
        default=[],
        metavar='KEY=START:STOP:COUNT',
        help='what is varied: wear_gain, or a dotted scenario key; also KEY=A,B,C; may be '
        'repeated, for every combination',
    )
    add_controllers_option(parser)
    parser.add_argument(
        '--metrics',
        default=','.join(TABLE_METRICS),
        metavar='A,B,...',
        help='metrics for table and figure, named as in scores.json; default: %(default)s',
    )
    parser.add_argument('--json', metavar='FILE', help="also write the rows; '-' is stdout")
    parser.add_argument('--csv', metavar='FILE', help="also write them as CSV; '-' is stdout")
    parser.add_argument(
        '--figure', metavar='FILE', help='also draw them: a .png, .svg or .html file'
    )
    parser.add_argument(
        '--spec',
        metavar='FILE',
        help='also write the specification with which `ddct campaign` keeps the same runs',
    )
    add_limits_option(parser)
    add_settings_options(parser)
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
