# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `check`: find a controller's errors; --new writes a package to start from."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_controllers.check.checks import FAIL, Outcome, check_controller
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.template.package import write_new
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.output_file import require_place
from ddct_plant.program.command_line import ProgramParser, complain, run_program, show_and_write
from ddct_plant.program.printed_table import print_table
from ddct_plant.program.table import TextTable, Weight
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.chosen import scenario_of
from ddct_plant.scenario.settings import KnownSettings

PROGRAM = 'ddct check'
_DESCRIPTION = """\
Try a controller alone and in the closed loop, and say what is wrong with it: where, and what to
do. The exit code is 1 when a check fails. With --new, write a package with a controller to start
from, with its entry point, test and README."""
_EPILOG = """\
examples:
  ddct check mine.py                           the class in a Python file
  ddct check mine                              a controller of an installed package
  ddct check designs/mine.yaml --json -        one in a YAML file
  ddct check mine --set controllers.mine.gain=0.2
  ddct check --new my_slip                     the package my_slip, to edit and install"""


@dataclass(frozen=True)
class CheckReport:
    """Document of `ddct check --json`."""

    controller: str
    checks: Sequence[Outcome]


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _check, argv)


def _check(argv: list[str]) -> int:
    parser = ProgramParser(prog=PROGRAM, description=_DESCRIPTION, epilog=_EPILOG)
    chosen = parser.add_mutually_exclusive_group(required=True)
    chosen.add_argument('controller', nargs='?', metavar='NAME|FILE', help='FILE is .py or .yaml')
    chosen.add_argument(
        '--new',
        metavar='NAME',
        help='write a package with this controller: lower-case letters, digits, underscores',
    )
    parser.add_argument(
        '--out', type=Path, metavar='DIR', help='folder for --new, not there yet; default: NAME'
    )
    add_scenario_options(parser, set_example='controllers.mine.gain=0.2')
    parser.add_argument('--json', metavar='FILE', help="write the report; '-' is stdout")
    options = parser.parse_args(argv)
    if options.new is not None:
        others = vars(options).keys() - {'new', 'out'}
        if any(getattr(options, name) != parser.get_default(name) for name in others):
            raise ParameterError('--new tries no controller: leave all options but --out out')
        print(write_new(options.new, options.out))
        return 0
    if options.out is not None:
        raise ParameterError('--out is the folder for --new NAME: leave it out')
    require_place('--json', options.json)
    if is_controller_file(options.controller) and not Path(options.controller).exists():
        raise ParameterError(f'{options.controller}: no such file')
    settings = KnownSettings(scenario_of(options, options.overrides))
    print(f'{PROGRAM}: trying {options.controller}', file=sys.stderr, flush=True)
    outcomes = check_controller(options.controller, settings)
    report = CheckReport(options.controller, outcomes)
    show_and_write(options.json, report, lambda: _print(outcomes))
    failed = [each.name for each in outcomes if each.state == FAIL]
    found = f'fails: {", ".join(failed)}' if failed else 'passes'
    complain(PROGRAM, f'{options.controller} {found}')
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
