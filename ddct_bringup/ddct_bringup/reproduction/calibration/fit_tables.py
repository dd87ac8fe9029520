# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the result of a calibration, and cells that all of its tables use."""

from collections.abc import Sequence

from ddct_bringup.reproduction.calibration.parameters import NAMES
from ddct_bringup.reproduction.calibration.record_types import (
    CalibrationRecord,
    FitEntry,
    OptimumEntry,
    ResidualEntry,
)
from ddct_bringup.thesis.table_5_1 import ROW_OF
from ddct_plant.program.table import Table

_METRIC_LABELS = {
    'engagement_time_s': 't_a, s',
    'torsion_speed_std_rpm': 'sigma w_sr, rpm',
    'acceleration_std_m_s2': 'sigma A_x, m/s^2',
}
VALUE_HEADERS = ('C_m start', 'C_m end', 'rise end', 'slope', 'K_p', 'K_i')
"""Headers of the fitted parameters, in the order of NAMES."""


def residual_table(residuals: Sequence[ResidualEntry]) -> Table:
    """Return the nine fit residuals of the frozen scenario."""
    return Table(
        'Fit residuals of the frozen scenario (not reproductions: these numbers were fitted)',
        ('row', 'figure', 'printed', 'fitted', 'residual, %', 'tolerance, %'),
        [value_cells(entry) for entry in residuals],
    )


def parameter_table(record: CalibrationRecord) -> Table:
    """Return the fitted parameters with their bounds and standard deviations."""
    rows = [
        (
            f'{entry.symbol}, {entry.unit}',
            number(entry.lower),
            number(entry.upper),
            number(entry.value) + (' (at bound)' if entry.at_bound else ''),
            number(entry.frozen, 4),
            number(entry.std, 2),
            '-' if entry.std_given_start is None else number(entry.std_given_start, 2),
            entry.bounds_from,
        )
        for entry in record.parameters
    ]
    ends = sorted({entry.window_end_s for entry in record.windows})
    end = number(record.score_window_s[1])
    why = 'from the slowest printed engagement to the end of the run, tenths of a second'
    rows.append(
        ('score window end, s', number(ends[0]), number(ends[-1]), end, end, '-', '-', why)
    )
    return Table(
        'Fitted parameters',
        (
            'parameter',
            'lower',
            'upper',
            'optimum',
            'frozen',
            'std',
            'std, C_m start held',
            'bounds from',
        ),
        rows,
    )


def torque_table(record: CalibrationRecord) -> Table:
    """Return torque levels and slopes at the optimum with their standard errors."""
    return Table(
        'Engine torque and reference, with standard errors',
        ('quantity', 'optimum', 'standard error', 'standard error, C_m start held'),
        [
            (
                f'{entry.quantity}, {entry.unit}',
                number(entry.value),
                number(entry.std, 2),
                number(entry.std_given_start, 2) if entry.std_given_start else '-',
            )
            for entry in record.torque_and_slopes
        ],
    )


def optima_table(title: str, optima: Sequence[OptimumEntry]) -> Table:
    """Return local optima, one a row."""
    return Table(
        title,
        ('window end, s', 'PI', 'PI loop', 'objective', 'worst, tolerances', *VALUE_HEADERS),
        [
            (
                number(one.window_end_s),
                one.pi_kind,
                'stable' if one.pi_stable else f'grows {one.pi_growth_rate_per_s:.2f}/s',
                *fit_cells(one.fit),
            )
            for one in optima
        ],
    )


def fit_table(record: CalibrationRecord) -> Table:
    """Return the table of the overall quality of the fit."""
    objective, analysis = record.objective, record.identifiability
    weakest = [
        f'{entry.symbol} {analysis.weakest[entry.name]:+.2f} {entry.unit}'
        for entry in record.parameters
        if abs(analysis.weakest[entry.name]) > 0.1
    ]
    within = [
        number(one.window_end_s)
        for one in record.windows
        if one.pi_stable and abs(one.fit.worst_residual) <= 1.0
    ]
    return Table(
        'The fit as a whole',
        ('quantity', 'value'),
        [
            ('objective at the optimum', f'{objective.value:.3f}'),
            ('objective at the frozen values', f'{record.frozen_objective:.3f}'),
            ('numbers fitted to', str(objective.numbers)),
            ('values fitted, window end included', str(objective.fitted)),
            ('degrees of freedom', str(analysis.degrees_of_freedom)),
            ('std of a scaled residual', f'{analysis.residual_std:.2f}'),
            ('std in half a 95 % interval (Student)', f'{analysis.coverage_95:.1f}'),
            ('undetermined together', ', '.join(weakest)),
            ('window ends with a stable fit within all tolerances, s', ', '.join(within)),
        ],
    )


def value_cells(entry: ResidualEntry) -> tuple[str, ...]:
    """Return a printed value, the computed one, the deviation and its tolerance."""
    return (
        ROW_OF[entry.row].label,
        _METRIC_LABELS[entry.figure],
        f'{entry.printed:.2f}',
        f'{entry.computed:.3f}',
        signed(100.0 * entry.deviation, 1),
        number(100.0 * entry.tolerance),
    )


def fit_cells(one: FitEntry) -> tuple[str, ...]:
    """Return the quality of a fit, and its values in the order of VALUE_HEADERS."""
    forms = ('{:.1f}', '{:.1f}', '{:.3f}', '{:.1f}', '{:.3f}', '{:.4f}')
    return (
        f'{one.objective:.3f}',
        signed(one.worst_residual, 2),
        *(form.format(one.values[name]) for form, name in zip(forms, NAMES, strict=True)),
    )


def number(value: float, digits: int = 4) -> str:
    """Return the value with so many significant digits, without an exponent."""
    rounded = float(f'{value:.{digits - 1}e}')
    return f'{rounded:.0f}' if abs(rounded) >= 10 ** (digits - 1) else f'{rounded:.{digits}g}'


def signed(value: float, decimals: int) -> str:
    """Return the value with its sign, that of zero positive."""
    return f'{round(value, decimals) + 0.0:+.{decimals}f}'
