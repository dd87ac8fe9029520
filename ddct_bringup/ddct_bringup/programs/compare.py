# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `compare`: run several controllers, score them, and set them beside the thesis."""

import argparse
import sys
from functools import partial
from pathlib import Path

from ddct_bringup.digests.writing import write_run_digests
from ddct_bringup.programs.report import REPORT_FILE, require_chart_library, write_report
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_bringup.report.run_labels import in_order
from ddct_bringup.run.description import custom_data
from ddct_bringup.run.execution import print_logs_with_warnings, run_with_progress
from ddct_bringup.run.options import (
    ALL,
    add_controllers_option,
    add_run_options,
    controllers_of,
    print_choices,
    scheduling_of,
)
from ddct_bringup.run.output_folder import StagedFolder, locked_folders, mark_folder
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.run_base import settings_of
from ddct_bringup.run.timing_and_failure import note_failure
from ddct_bringup.scores.comparison_table import print_comparison
from ddct_bringup.scores.document import scores_document
from ddct_bringup.scores.floors import add_floors_option, with_floors
from ddct_bringup.scores.scored_recording import ScoredRecording, run_and_score, score_any_bag
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits, add_limits_option, load_limits
from ddct_controllers.registry import controller_label, working_controllers
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import FrequencyEvidence
from ddct_plant.base.errors import DdctError, ParameterError, printable
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT, require_place
from ddct_plant.program.command_line import ProgramParser, complain, run_program

PROGRAM = 'ddct compare'
SCORES_FILE = 'scores.json'

_EPILOG = """\
examples:
  ddct compare --controllers pi,ls8,hinf1 --out runs/demo --overwrite
  ddct compare --controllers all --wear-gain 0.7 --out runs/worn
  ddct compare --controllers pi,mine --headless --json - --out runs/mine
  ddct compare --controllers pi,mine.py --headless --out runs/mine     the class in a file

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
    options = _parser().parse_args(argv)
    if options.list:
        print_choices()
        return 0
    if options.out is None:
        raise ParameterError('--out is missing: name the folder for the bags')
    require_chart_library()
    require_place('--json', options.json)
    unusable: list[DdctError] = []
    if options.layout == 'processes':
        # Only here: a headless run needs no processes.
        from ddct_bringup.processes.fork_server import start_server

        start_server()  # it imports while the runs are planned, and serves them all
    limits = load_limits(options.limits)
    names = controllers_of(options.controllers)
    settings = settings_of(options, [controller_label(name) for name in names])
    if options.controllers == ALL:
        names = working_controllers(settings, partial(complain, PROGRAM))
    scheduling = scheduling_of(options)
    plans = [RunPlan(settings, name, options.layout, scheduling) for name in names]
    with (
        locked_folders(options.out),
        StagedFolder(options.out, overwrite=options.overwrite) as folder,
    ):
        evidence = frequency_evidence(names, settings, unusable.append)
        failed = _run_all(plans, folder, evidence, options, limits)
    if failed:
        complain(PROGRAM, f'not valid: {", ".join(failed)}: the table and the report say why')
    for error in unusable:
        complain(PROGRAM, f'{error}; its run counts, but it has no margins')
    return 1 if failed or unusable else 0


def _run_all(
    plans: list[RunPlan],
    folder: StagedFolder,
    evidence: FrequencyEvidence,
    options: argparse.Namespace,
    limits: Limits,
) -> list[str]:
    """
    Execute all runs, commit their folder, and return the names of those that are not valid.

    Raise DdctError when none is valid: DIR stays as it was.
    """
    runs = [
        _run(plan, folder.path, f'{index} of {len(plans)}, ', limits)
        for index, plan in enumerate(plans, start=1)
    ]
    runs = with_floors(runs, limits, options.floors)
    scored = [run.scores for run in runs]
    write_json(str(folder.path / SCORES_FILE), scores_document(scored, limits))
    _report(scored, plans, options, limits)
    failed = [plan.name for plan, run in zip(plans, scored, strict=True) if not run.valid]
    if len(failed) == len(plans):
        print_logs_with_warnings(PROGRAM, [folder.path / plan.name for plan in plans])
        raise DdctError(f'no run is valid ({", ".join(failed)}): {folder.left}')
    write_json(str(folder.path / FREQUENCY_FILE), evidence)
    write_report(in_order(runs), str(folder.path / REPORT_FILE), limits)
    write_run_digests(folder.path, {plan.name: plan for plan in plans})
    folder.commit()
    print_logs_with_warnings(PROGRAM, [folder.final / plan.name for plan in plans])
    print(
        f'{PROGRAM}: bags, {SCORES_FILE}, {FREQUENCY_FILE} and {REPORT_FILE} are in '
        f'{folder.final}',
        file=sys.stderr,
    )
    return failed


def _run(plan: RunPlan, out: Path, label: str, limits: Limits) -> ScoredRecording:
    """
    Execute, read and score one run; write the reason of a failed one into its folder.

    Raise DdctError when that folder cannot be written, as on a full disk: other runs would fail
    too.
    """
    bag = out / plan.name
    mark_folder(bag)
    try:
        return run_and_score(plan, bag, limits, partial(run_with_progress, label=label))
    except DdctError as error:
        reason = str(error)
    reason = reason.replace(f'{bag}/', '')  # the folder gets its final name later
    complain(PROGRAM, f'{plan.name}: {reason}')
    note_failure(bag, reason, custom_data(plan.settings, plan.name, plan.steps))
    return score_any_bag(bag, out, limits)


def _report(
    scored: list[ScoredRun],
    plans: list[RunPlan],
    options: argparse.Namespace,
    limits: Limits,
) -> None:
    settings = plans[0].settings
    if options.json:
        write_json(options.json, scores_document(scored, limits))
    stream = sys.stderr if options.json == STDOUT else sys.stdout
    for line in settings.scenario.adjusted:
        print(printable(line), file=stream)
    print_comparison(scored, settings, options.overrides, stream)


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Run controllers in the same closed loop and compare their scores.',
        epilog=_EPILOG,
    )
    add_controllers_option(parser)
    parser.add_argument('--out', type=Path, metavar='DIR', help='folder for all of it')
    parser.add_argument('--json', metavar='FILE', help="also write the scores; '-' is stdout")
    add_limits_option(parser)
    add_floors_option(parser)
    add_run_options(parser)
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
