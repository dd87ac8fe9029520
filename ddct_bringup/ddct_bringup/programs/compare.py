# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `compare`: run one controller or several in the same closed loop, and score."""

import argparse
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import (
    ALL,
    add_controllers_option,
    add_floors_option,
    add_limits_option,
    add_live_option,
    add_run_options,
    execution,
    settings_given,
    wants_floors,
)
from ddct_plant.base.errors import DdctError, ParameterError, printable
from ddct_plant.files.output_file import STDOUT, require_place
from ddct_plant.program.command_line import (
    ProgramParser,
    complain,
    run_program,
    split_ros_arguments,
)

PROGRAM = 'ddct compare'
_complain = partial(complain, PROGRAM)

_EPILOG = """\
examples:
  ddct compare --controllers ls8 --out runs/first               one run through the graph
  ddct compare --controllers pi,ls8,hinf1 --out runs/demo --overwrite
  ddct compare --controllers pi,mine.py --headless --out runs/mine     no ROS, a class in a file
  ddct compare --controllers all --wear-gain 0.7 --set load.slope_rad=0.05 --out runs/worn
  ddct compare --controllers pi --case vehicle.mass_kg=1700 --out runs/loaded     unknown mass
  ddct compare --controllers ls8 --mode realtime --live --out runs/live    seen in Foxglove
  ddct compare --out runs/car --ros-args -r __ns:=/car -r /clock:=/car/clock

Writes one bag per controller, DIR/scores.json, DIR/frequency.json with the margins of the
linear ones, and DIR/report.html, a page that shows all of it. A run that fails does not stop the
others: DIR has its reason and its logs, and the exit code is 1, as where a controller's
linear_model cannot be used: its run counts, but has no margins. When no run is valid, or on
Ctrl-C, DIR is not touched, and what was recorded stays in DIR.partial.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _compare, argv)


def _compare(argv: list[str]) -> int:
    own, for_ros = split_ros_arguments(argv)
    options = _parser().parse_args(own)
    if options.list:
        shell.print_choices()
        return 0
    shell.require_chart_library()
    require_place('--json', options.json)
    if options.layout == 'processes':
        shell.start_server()  # it imports while the runs are planned, and serves them all
    limits = shell.load_limits(options.limits)
    everyone = options.controllers == ALL
    plans = shell.planned(
        None if everyone else shell.controllers_of(options.controllers),
        options.layout,
        _complain,
        shell.GraphNames.of(for_ros),
        **settings_given(options),
    )
    if options.out is None:
        raise ParameterError('--out is missing: name the folder for the bags')
    shell.print_adjusted(plans[0].settings.scenario)
    if options.live is not None and len(plans) > 1:
        raise ParameterError(f'--live shows one run, not {len(plans)}: name one controller')
    comparer = shell.Comparer(
        execution(options), _complain, partial(_show, plans, options, limits)
    )
    floors = wants_floors(options)
    try:
        scored, unusable = shell.compare_into(
            plans, options.out, limits, comparer, overwrite=options.overwrite, floors=floors
        )
    except shell.NoValidRunError:
        left = options.out.with_name(f'{options.out.name}{shell.PARTIAL}')
        shell.print_kept_logs(PROGRAM, [left / plan.name for plan in plans])
        raise
    shell.print_kept_logs(PROGRAM, [options.out / plan.name for plan in plans])
    *names, last = shell.FILES
    _complain(f'bags, {", ".join(names)} and {last} are in {options.out}')
    return _failures(plans, scored, unusable)


def _show(
    plans: Sequence['shell.RunPlan'],
    options: argparse.Namespace,
    limits: 'shell.Limits',
    scored: Sequence['shell.ScoredRun'],
) -> None:
    """Print the table of a comparison, and write `--json`."""
    settings = plans[0].settings
    if options.json:
        shell.write_json(options.json, shell.scores_document(scored, limits))
    stream = sys.stderr if options.json == STDOUT else sys.stdout
    for line in settings.scenario.adjusted:
        print(printable(line), file=stream)
    shell.print_comparison(scored, settings, options.overrides, stream)


def _failures(
    plans: Sequence['shell.RunPlan'],
    scored: Sequence['shell.ScoredRun'],
    unusable: Sequence[DdctError],
) -> int:
    """Print which runs do not count or have no margins; return the exit code."""
    failed = [plan.name for plan, run in zip(plans, scored, strict=True) if not run.valid]
    if failed:
        _complain(f'not valid: {", ".join(failed)}: the table and the report say why')
    for error in unusable:
        _complain(f'{error}; its run counts, but it has no margins')
    return 1 if failed or unusable else 0


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Run controllers, one or several, in the same closed loop; record and score.',
        epilog=_EPILOG,
    )
    add_controllers_option(parser)
    parser.add_argument('--out', type=Path, metavar='DIR', help='folder for all of it')
    parser.add_argument('--json', metavar='FILE', help="also write the scores; '-' is stdout")
    add_limits_option(parser)
    add_floors_option(parser)
    add_live_option(parser)
    add_run_options(parser)
    parser.add_argument(
        '--ros-args',
        nargs=argparse.REMAINDER,
        help='namespace and topics of the graph, as -r __ns:=/NAMESPACE -r /TOPIC:=/OTHER',
    )
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
