# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
r"""
Fit the scenario `thesis` again to the LS8, Hinf1 and PI rows of Table 5.1.

    tools/run calibrate            search every end of the score window, minutes
    tools/run calibrate --quick    only the fit from the packaged values, seconds
    tools/run calibrate --quick --set initial.shaft_speed_rad_s=120 \
        --set initial.engine_speed_rad_s=120

The exit code is 1 when the fit ends elsewhere than the packaged scenario is: at another end of the
score window, or by more than 1 % of the range of a parameter.
"""

import argparse
import sys
from collections.abc import Sequence
from functools import partial

import numpy as np

from calibrate.problem import PARAMETERS, RANGE, ROWS, Problem, values_of
from calibrate.search import Fit, fit, lowest_stable, search
from ddct_bringup.thesis.table_5_1 import FORMS, ROW_OF, TOLERANCES
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.program.command_line import complain
from ddct_plant.program.printed_table import print_tables
from ddct_plant.program.table import TextTable
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario

RETURN_TOLERANCE = 0.01
"""Largest difference of a fitted parameter from the packaged one, as a share of its range."""
_DECIMALS = (1, 1, 4, 2, 4, 5)
"""Decimals of the values in the tables, in the order of PARAMETERS."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program and return its exit code."""
    parser = argparse.ArgumentParser(
        prog='tools/run calibrate',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('--quick', action='store_true', help='only fit from the packaged values')
    parser.add_argument(
        '--set',
        action='append',
        default=[],
        metavar='KEY=VALUE',
        help='another assumption, a key of the scenario; the result is then not compared',
    )
    parser.add_argument('--json', metavar='FILE', help='also write the tables')
    options = parser.parse_args(arguments)
    base, progress = load_scenario('thesis', options.set), partial(complain, 'calibrate')
    quick = options.quick
    fits = [_from_packaged(base)] if quick else search(base, progress)
    best = lowest_stable(fits)
    tables = {
        'fits': _fits_table(fits),
        'parameters': _parameter_table(best, base),
        'residuals': _residual_table(best),
    }
    print_tables(tables.values())
    if options.json:
        write_json(options.json, {name: table.written for name, table in tables.items()})
    if not options.set:
        require_packaged(best, base)
    return 0


def _from_packaged(base: Scenario) -> Fit:
    return fit(Problem(base, base.score_window_s[1]), values_of(base))


def differences(found: Fit, packaged: Scenario) -> dict[str, float]:
    """
    Return fitted less packaged values as shares of the parameters' ranges, by symbol.

    Of C_m its rise is compared, as the nine numbers do not determine its level.
    """
    change = found.values - values_of(packaged)
    rise = {'rise of C_m': (change[1] - change[0]) / RANGE[1]}
    others = zip(PARAMETERS[2:], change[2:] / RANGE[2:], strict=True)
    return rise | {parameter.symbol: share for parameter, share in others}


def require_packaged(found: Fit, packaged: Scenario) -> None:
    """Raise DdctError where a fit is not the packaged scenario within RETURN_TOLERANCE."""
    end = packaged.score_window_s[1]
    if found.problem.window_end_s != end:
        raise DdctError(
            f'the score window of the best fit ends at {found.problem.window_end_s:g} s, that of '
            f'the scenario thesis at {end:g} s'
        )
    shares = differences(found, packaged)
    name = max(shares, key=lambda name: abs(shares[name]))
    if abs(shares[name]) > RETURN_TOLERANCE:
        raise DdctError(
            f'the fit moves {name} of the scenario thesis by {100.0 * shares[name]:+.1f} % of its '
            f'range, more than {100.0 * RETURN_TOLERANCE:g} %'
        )


def _fits_table(fits: Sequence[Fit]) -> TextTable:
    return TextTable(
        'Fits',
        (
            *('window to s', 'objective', 'worst, tolerances', 'PI loop 1/s'),
            *(parameter.symbol for parameter in PARAMETERS),
        ),
        [
            (
                f'{one.problem.window_end_s:.1f}',
                f'{one.objective:.3f}',
                f'{one.residuals[np.argmax(np.abs(one.residuals))]:+.2f}',
                f'{one.pi_growth_rate:+.2f}',
                *_cells(one.values),
            )
            for one in fits
        ],
    )


def _parameter_table(best: Fit, packaged: Scenario) -> TextTable:
    errors = ['-', *(f'{error:.2g}' for error in best.standard_errors())]
    shares = ['-', *(f'{100.0 * share:+.2f}' for share in differences(best, packaged).values())]
    return TextTable(
        'Lowest objective with a stable PI loop, beside the packaged scenario',
        (
            *('parameter', 'lower', 'upper', 'fitted', 'packaged', 'difference, % of range'),
            'standard error, C_m start held',
        ),
        [
            (
                f'{parameter.symbol}, {parameter.unit}',
                f'{parameter.lower:g}',
                f'{parameter.upper:g}',
                value,
                frozen,
                share,
                error,
            )
            for parameter, value, frozen, share, error in zip(
                PARAMETERS,
                _cells(best.values),
                _cells(values_of(packaged)),
                shares,
                errors,
                strict=True,
            )
        ],
    )


def _residual_table(best: Fit) -> TextTable:
    rows = []
    residuals = iter(best.residuals)
    for row in ROWS:
        for name, printed in ROW_OF[row].printed_values().items():
            deviation = next(residuals) * TOLERANCES[name]
            rows.append(
                (
                    *(ROW_OF[row].label, name, f'{printed:g}'),
                    f'{printed * (1.0 + deviation):{FORMS[name]}}',
                    f'{100.0 * deviation:+.1f}',
                    f'{100.0 * TOLERANCES[name]:g}',
                )
            )
    return TextTable(
        'Fit residuals (not reproductions: these numbers were fitted)',
        ('row', 'figure', 'printed', 'fitted', 'residual, %', 'tolerance, %'),
        rows,
    )


def _cells(values: Sequence[float] | np.ndarray) -> list[str]:
    return [f'{value:.{digits}f}' for value, digits in zip(values, _DECIMALS, strict=True)]


if __name__ == '__main__':
    try:
        sys.exit(main())
    except DdctError as error:
        sys.exit(f'calibrate: {error}')
