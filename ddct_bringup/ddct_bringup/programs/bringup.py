# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `bringup`: start the graph, wait for its end, stop it, leave one bag."""

import argparse
import sys
from contextlib import nullcontext
from functools import partial
from pathlib import Path

from ddct_bringup.processes.live_process import DEFAULT_PORT, live_view
from ddct_bringup.run.execution import print_logs_with_warnings, run_with_progress
from ddct_bringup.run.options import add_run_options, print_choices, scheduling_of
from ddct_bringup.run.output_folder import StagedFolder, run_folder
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.run_base import settings_of
from ddct_bringup.scores.floors import NONE, add_floors_option, with_least
from ddct_bringup.scores.run_notes import slow_notes
from ddct_bringup.scores.scored_recording import ScoredRecording, run_and_score
from ddct_bringup.scores.validity import realtime_summary
from ddct_bringup.verdict.limits import Limits, add_limits_option, load_limits
from ddct_controllers.registry import controller_label
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.program.command_line import ProgramParser, run_program
from ddct_plant.scenario.differences import scenario_title
from ddct_plant.signals.gain_changes import changes_note

PROGRAM = 'ddct bringup'

_EPILOG = """\
examples:
  ddct bringup --out runs/first                          the PI of the thesis
  ddct bringup --controller ls8 --out runs/first         another one into the same folder
  ddct bringup --controller mine.py --out runs/first     the class in a Python file
  ddct bringup --wear-gain 0.7 --set load.slope_rad=0.05 --out runs/worn-uphill
  ddct bringup --mode realtime --out runs/realtime       100 Hz on the wall clock
  ddct bringup --headless --out runs/quick               the same numbers without a graph
  ddct bringup --mode realtime --live --out runs/live    watch it in Foxglove

The bag is DIR/<controller>/<controller>_0.mcap. A run that fails leaves what it recorded
in DIR/<controller>.partial. ROS_DOMAIN_ID is respected; without it a free domain is taken.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _bringup, argv)


def _bringup(argv: list[str]) -> int:
    options = _parser().parse_args(argv)
    if options.list:
        print_choices()
        return 0
    if options.out is None:
        raise ParameterError('--out is missing: name the folder for the bag')
    if options.layout == 'processes':
        # Only here: a headless run needs no processes.
        from ddct_bringup.processes.fork_server import start_server

        start_server()  # it imports while the run is planned
    limits = load_limits(options.limits)
    settings = settings_of(options, [controller_label(options.controller)])
    plan = RunPlan(settings, options.controller, options.layout, scheduling_of(options))
    if options.live is not None and plan.layout != 'processes':
        raise ParameterError(f'--live shows a process per node: drop it or --{plan.layout}')
    with run_folder(options.out, plan.name, overwrite=options.overwrite) as folder:
        _run(plan, folder, options, limits)
    return 0


def _run(
    plan: RunPlan,
    folder: StagedFolder,
    options: argparse.Namespace,
    limits: Limits,
) -> None:
    with live_view(options.live) if options.live is not None else nullcontext() as live:
        execute = partial(run_with_progress, live=live)
        run = run_and_score(plan, folder.path, limits, execute)
    scores = run.scores
    if not scores.valid:
        _print_notes(run, folder.path)
        raise DdctError(f'{folder.path}: not valid: {scores.reason}')
    folder.commit()
    print(folder.final, flush=True)
    if options.floors != NONE:
        scores = with_least(run, limits).scores
    if changes := scores.scenario_changes:
        title = scenario_title(plan.settings.scenario.name, changes)
        print(f'{PROGRAM}: {title}', file=sys.stderr)
    _print_notes(run, folder.final)
    for note in filter(None, (changes_note(scores.gain_changes), *slow_notes(scores))):
        print(f'{PROGRAM}: {note}', file=sys.stderr)
    why = f': {scores.why}' if scores.why else ''
    print(f'{PROGRAM}: {scores.state}{why}', file=sys.stderr)


def _print_notes(run: ScoredRecording, folder: Path) -> None:
    """Print the logs with warnings and the summary of a real-time run on standard error."""
    print_logs_with_warnings(PROGRAM, [folder])
    if run.recording and not run.recording.facts.lockstep:
        print(f'{PROGRAM}: {realtime_summary(run.recording)}', file=sys.stderr)


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
    parser.add_argument(
        '--live',
        nargs='?',
        type=int,
        const=DEFAULT_PORT,
        metavar='PORT',
        help=f'let Foxglove watch; the run waits for it; PORT is {DEFAULT_PORT} unless given',
    )
    add_limits_option(parser)
    add_floors_option(parser)
    add_run_options(parser)
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
