# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `identify`: driveline parameters from the thesis's transfer functions, or from a log."""

from typing import Any

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.identification.checks import (
    IdentificationCheck,
    check_identification,
    parameter_ranges,
    smallest_worst_residual,
)
from ddct_plant.identification.coefficients import (
    FITTED,
    PRINTED,
    SYMBOLS_AND_UNITS,
    PrintedCoefficients,
)
from ddct_plant.identification.fit import Identification, identify_driveline
from ddct_plant.identification.from_log.command import add_log_options, identify_log
from ddct_plant.models.printed import CLUTCH_TO_SLIP_AS_PRINTED
from ddct_plant.program.command_line import ProgramParser, run_program, show_and_write
from ddct_plant.program.table import Table, print_tables, text_or_dash

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
  ddct identify --from runs/demo/pi --check runs/demo/ls8 --out mycar.yaml
  ddct identify --from drive.csv --columns columns.yaml --fix total_ratio"""


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
    if (
        options.columns
        or options.check
        or options.fix
        or options.out
        or options.overrides
        or options.force
    ):
        raise DdctError(
            '--columns, --check, --fix, --set, --force and --out need a log: give --from LOG'
        )
    coefficients = PRINTED
    if options.as_printed:
        coefficients = PrintedCoefficients(CLUTCH_TO_SLIP_AS_PRINTED)
    identification = identify_driveline(coefficients)
    worst, centre = smallest_worst_residual(coefficients, identification.logarithms)
    checks = check_identification(identification, coefficients, worst)
    ranges = parameter_ranges(coefficients, centre) if worst <= 1.0 else None
    content = _content(identification, ranges, checks)
    show_and_write(options.json, content, lambda: _print_tables(content))
    failed = [check.name for check in checks if not check.passed]
    if failed:
        advice = '; leave out --as-printed' if options.as_printed else ''
        raise DdctError(f'no driveline fits: {"; ".join(failed)}{advice}')
    return 0


def _content(
    identification: Identification,
    ranges: np.ndarray | None,
    checks: tuple[IdentificationCheck, ...],
) -> dict[str, Any]:
    """Return the result for tables and JSON; null for a value that does not exist."""
    values, parameters = identification.parameters.values(), []
    for name, (symbol, unit) in SYMBOLS_AND_UNITS.items():
        value = values[name]
        row = {'name': name, 'symbol': symbol, 'value': value, 'std': None, 'unit': unit}
        row |= {'lowest': None, 'highest': None}
        if name in FITTED:
            index = FITTED.index(name)
            row['std'] = value * float(identification.relative_std[index])
            if ranges is not None:
                row['lowest'], row['highest'] = ranges[index].tolist()
        parameters.append(row)
    weakest = zip(FITTED, identification.weakest_direction.tolist(), strict=True)
    return {
        'parameters': parameters,
        'coefficients': [vars(fit) for fit in identification.coefficients],
        'checks': [vars(check) | {'passed': check.passed} for check in checks],
        'fit': {
            'degrees_of_freedom': identification.degrees_of_freedom,
            'chi_square': identification.chi_square,
            'condition': identification.condition,
            'weakest_direction': dict(weakest),
        },
    }


def _print_tables(content: dict[str, Any]) -> None:
    tables = [
        Table(
            'Driveline parameters',
            ('parameter', 'symbol', 'value', 'std', 'lowest', 'highest', 'unit'),
            [
                (
                    row['name'],
                    row['symbol'],
                    text_or_dash(row['value'], '.7g'),
                    text_or_dash(row['std'], '.2g'),
                    text_or_dash(row['lowest'], '.5g'),
                    text_or_dash(row['highest'], '.5g'),
                    row['unit'],
                )
                for row in content['parameters']
            ],
        ),
        Table(
            'Printed coefficients',
            ('function', 'coefficient', 'printed', 'computed', 'residual, half-units'),
            [
                (
                    row['transfer_function'],
                    row['coefficient'],
                    row['printed'],
                    text_or_dash(row['computed'], '.7g'),
                    f'{round(row["residual_half_units"], 2) + 0.0:+.2f}',
                )
                for row in content['coefficients']
            ],
        ),
        Table(
            'Checks',
            ('check', 'value', 'lowest', 'highest', 'passed'),
            [
                (
                    row['name'],
                    *(text_or_dash(row[key], '.6g') for key in ('value', 'lowest', 'highest')),
                    'yes' if row['passed'] else 'no',
                )
                for row in content['checks']
            ],
        ),
    ]
    print_tables(tables)
    weakest = ', '.join(
        f'{SYMBOLS_AND_UNITS[name][0]} {share:+.2f}'
        for name, share in content['fit']['weakest_direction'].items()
    )
    print(f'Condition number {content["fit"]["condition"]:.0f}; least determined together:')
    print(f'  {weakest} (relative changes)')
