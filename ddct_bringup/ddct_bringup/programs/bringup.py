# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `bringup` of `ros2 run`: start the graph, wait for its end, stop it, leave one bag."""

import argparse
from functools import partial
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import (
    add_floors_option,
    add_limits_option,
    add_live_option,
    add_run_options,
    execution,
    settings_given,
    wants_floors,
)
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.program.command_line import (
    ProgramParser,
    complain,
    run_program,
    split_ros_arguments,
)

PROGRAM = 'bringup'
_complain = partial(complain, PROGRAM)

_EPILOG = """\
examples, where ROS 2's own command line is installed:
  ros2 run ddct_bringup bringup --out runs/first                     the PI of the thesis
  ros2 run ddct_bringup bringup --controller ls8 --out runs/first    one more, same folder
  ros2 run ddct_bringup bringup --mode realtime --live --out runs/live

`ddct compare` takes the same options, and leaves scores and a page too.
The bag is DIR/<controller>/<controller>_0.mcap. A run that fails leaves what it recorded
in DIR/<controller>.partial. ROS_DOMAIN_ID is respected; without it a free domain is taken.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _bringup, argv)


def _bringup(argv: list[str]) -> int:
    own, for_ros = split_ros_arguments(argv)
    options = _parser().parse_args(own)
    if options.list:
        shell.print_choices()
        return 0
    if options.out is None:
        raise ParameterError('--out is missing: name the folder for the bag')
    if options.layout == 'processes':
        shell.start_server()  # it imports while the run is planned
    limits = shell.load_limits(options.limits)
    (plan,) = shell.planned(
        [options.controller],
        options.layout,
        _complain,
        shell.GraphNames.of(for_ros),
        **settings_given(options),
    )
    shell.print_adjusted(plan.settings.scenario)
    run = shell.keep_run(
        plan, options.out, limits, execution(options), overwrite=options.overwrite
    )
    folder = run.path.parent
    if not run.scores.valid:
        _print_notes(run, folder)
        raise DdctError(f'{folder}: not valid: {run.scores.reason}')
    print(folder, flush=True)
    _show(shell.with_least(run, limits) if wants_floors(options) else run, folder)
    return 0


def _show(run: 'shell.ScoredRecording', folder: Path) -> None:
    """Print the state of a valid run, and notes on it, on standard error."""
    scores = run.scores
    if scores.scenario_changes:
        _complain(shell.scenario_title(scores.scenario or '', scores.scenario_changes))
    _print_notes(run, folder)
    for note in filter(None, (shell.changes_note(scores.gain_changes), *shell.slow_notes(scores))):
        _complain(note)
    _complain(f'{scores.state}{f": {scores.why}" if scores.why else ""}')


def _print_notes(run: 'shell.ScoredRecording', folder: Path) -> None:
    """Print the logs with warnings and the summary of a real-time run on standard error."""
    shell.print_kept_logs(PROGRAM, [folder])
    if run.recording and not run.recording.facts.lockstep:
        _complain(shell.realtime_summary(run.recording))


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Run one controller in the closed loop and record it as a bag.',
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--controller',
        default='pi',
        metavar='NAME|FILE',
        help='one of --list, or a controller file, .py or .yaml; default: %(default)s',
    )
    parser.add_argument(
        '--out', type=Path, metavar='DIR', help='the bag goes to DIR/<controller>/'
    )
    add_live_option(parser)
    add_limits_option(parser)
    add_floors_option(parser)
    add_run_options(parser)
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
