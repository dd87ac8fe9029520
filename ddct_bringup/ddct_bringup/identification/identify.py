# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `identify`: the parameters of a car, from a log or from the thesis."""

from ddct_bringup.identification.checks import (
    check_identification,
    parameter_ranges,
    smallest_worst_residual,
)
from ddct_bringup.identification.coefficients import (
    PRINTED,
    PrintedCoefficients,
)
from ddct_bringup.identification.fit import identify_driveline
from ddct_bringup.identification.from_log.command import add_log_options, identify_log
from ddct_bringup.identification.identification_report import (
    document_of,
    parameters_of,
    print_identification,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.models.printed import CLUTCH_TO_SLIP_AS_PRINTED
from ddct_plant.program.command_line import ProgramParser, run_program, show_and_write
from ddct_plant.scenario.choices.scenarios import CHOICES

PROGRAM = 'ddct identify'
_DESCRIPTION = """\
Derive the driveline parameters from the nine printed coefficients of P2 and P3
(thesis, Section 1.6.2) by least squares weighted by the rounding of the print.
P1 and the zero pair of P2 are checks. A residual is computed less printed, in
half-units of the last printed digit; std follows from the rounding alone, and
lowest and highest are the ends of what the printed digits allow.
With --from it finds the driveline of a measured car instead, from the speeds and torques
of a log, with intervals and a prediction of data that took no part."""
_EXAMPLES = """\
examples:
  ddct identify
  ddct identify --json parameters.json
  ddct identify --as-printed    (334.4, an erratum: nothing fits; exit code 1)
  ddct identify --from runs/demo/pi --check runs/demo/ls8 --out mycar
  ddct identify --from drive.csv --columns columns.yaml --fix total_ratio
  ddct identify --from drive.mf4 --dbc car.dbc --guess columns.yaml"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _run, argv)


def _run(argv: list[str]) -> int:
    parser = ProgramParser(
        prog=PROGRAM,
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    parser.add_argument(
        '--json', metavar='FILE', help='write the result as JSON; - is standard output, alone'
    )
    parser.add_argument(
        '--as-printed', action='store_true', help='keep the 334.4 that Section 1.6.2 prints in P2'
    )
    add_log_options(parser)
    options = parser.parse_args(argv)
    if options.log:
        if options.as_printed:
            raise DdctError('--as-printed is about the thesis, --from about a log: give one')
        return identify_log(options)
    of_log = (
        *CHOICES,
        'columns',
        'dbc',
        'guess',
        'check',
        'fix',
        'overrides',
        'force',
        'out',
        'overwrite',
    )
    if any(getattr(options, name) for name in of_log):
        raise DdctError(
            '--scenario, --car, --drive, --columns, --dbc, --guess, --check, --fix, --set, '
            '--force, --out and --overwrite need a log: give --from LOG'
        )
    coefficients = PRINTED
    if options.as_printed:
        coefficients = PrintedCoefficients(CLUTCH_TO_SLIP_AS_PRINTED)
    identification = identify_driveline(coefficients)
    worst, centre = smallest_worst_residual(coefficients, identification.logarithms)
    checks = check_identification(identification, coefficients, worst)
    ranges = parameter_ranges(coefficients, centre) if worst <= 1.0 else None
    parameters = parameters_of(identification, ranges)
    show_and_write(
        options.json,
        document_of(identification, parameters, checks),
        lambda: print_identification(identification, parameters, checks),
    )
    failed = [check.name for check in checks if not check.passed]
    if failed:
        advice = '; leave out --as-printed' if options.as_printed else ''
        raise DdctError(f'no driveline fits: {"; ".join(failed)}{advice}')
    return 0
