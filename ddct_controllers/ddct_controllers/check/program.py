# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `check-controller`: find a controller's errors before its scores do."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from ddct_controllers.check.checks import FAIL, Outcome, check_controller
from ddct_plant.files.output_file import require_place
from ddct_plant.program.command_line import ProgramParser, complain, run_program, show_and_write
from ddct_plant.program.printed_table import print_table
from ddct_plant.program.table import TextTable, Weight
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.chosen import scenario_of
from ddct_plant.scenario.settings import KnownSettings

PROGRAM = 'ddct check-controller'
_DESCRIPTION = """\
Try a controller alone and in the closed loop, and say what is wrong with it: where, and what to
do. The exit code is 1 when a check fails."""
_EPILOG = """\
examples:
  ddct check-controller mine                             a controller of an installed package
  ddct check-controller mine.py                          the class in a Python file
  ddct check-controller designs/mine.yaml --json -       one in a YAML file
  ddct check-controller mine --set controllers.mine.gain=0.2"""


@dataclass(frozen=True)
class CheckReport:
    """Document of `check-controller --json`."""

    controller: str
    checks: Sequence[Outcome]


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _check, argv)


def _check(argv: list[str]) -> int:
    parser = ProgramParser(prog=PROGRAM, description=_DESCRIPTION, epilog=_EPILOG)
    parser.add_argument('controller', metavar='NAME|FILE', help='FILE is .py or .yaml')
    add_scenario_options(parser, set_example='controllers.mine.gain=0.2')
    parser.add_argument('--json', metavar='FILE', help="write the report; '-' is stdout")
    options = parser.parse_args(argv)
    require_place('--json', options.json)
    settings = KnownSettings(scenario_of(options, options.overrides))
    print(f'{PROGRAM}: trying {options.controller}', file=sys.stderr, flush=True)
    outcomes = check_controller(options.controller, settings)
    report = CheckReport(options.controller, outcomes)
    show_and_write(options.json, report, lambda: _print(outcomes))
    failed = [each.name for each in outcomes if each.state == FAIL]
    if failed:
        complain(PROGRAM, f'{options.controller} fails: {", ".join(failed)}')
    return 1 if failed else 0


def _print(outcomes: Sequence[Outcome]) -> None:
    """Print a row per check; those with the same state and detail share theirs."""
    alike: dict[tuple[str, str], list[str]] = {}
    for each in outcomes:
        alike.setdefault((each.state, each.detail), []).append(each.name)
    rows = [(state, ', '.join(names), detail) for (state, detail), names in alike.items()]
    print_table(TextTable('', ('state', 'checks', 'detail'), rows, weights=(Weight.NEEDED,)))


if __name__ == '__main__':
    raise SystemExit(main())
