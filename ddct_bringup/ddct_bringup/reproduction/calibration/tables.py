"""Tables of a calibration record, the same for the terminal and for the page of documentation."""

from collections.abc import Sequence

from ddct_bringup.reproduction.calibration.parameters import NAMES, Record
from ddct_bringup.thesis.table_5_1 import ROW_OF
from ddct_plant.program.table import Table

_FIGURE_LABELS = {
    'engagement_time_s': 't_a, s',
    'torsion_speed_std_rpm': 'sigma w_sr, rpm',
    'acceleration_std_m_s2': 'sigma A_x, m/s^2',
}
_VALUE_HEADERS = ('C_m start', 'C_m end', 'rise end', 'slope', 'K_p', 'K_i')


def all_tables(record: Record) -> dict[str, Table]:
    """Return every table of a whole calibration by name, in reading order."""
    end = _number(record['score_window_s'][1])
    return {
        'parameters': parameter_table(record),
        'torque_and_slopes': torque_table(record),
        'residuals': residual_table(record),
        'windows': optima_table('Optima by end of the score window', record['windows']),
        'starts': optima_table(f'Optima from every start, window to {end} s', record['starts']),
        'fit': fit_table(record),
        'directions': direction_table(record),
        'correlation': correlation_table(record),
        'left_out': left_out_table(record),
        'assumptions': assumption_table(record),
    }


def check_tables(record: Record) -> list[Table]:
    """Return the tables of a check of the frozen scenario."""
    moves = Table(
        'Local refit from the frozen scenario',
        ('parameter', 'move, % of its range'),
        [(name, _signed(100.0 * share, 2)) for name, share in record['moved'].items()],
    )
    return [residual_table(record), moves]


def residual_table(record: Record) -> Table:
    """Return the nine fit residuals of the frozen scenario."""
    return Table(
        'Fit residuals of the frozen scenario (not reproductions: these numbers were fitted)',
        ('row', 'figure', 'printed', 'fitted', 'residual, %', 'tolerance, %'),
        [_figure_cells(entry) for entry in record['residuals']],
    )


def parameter_table(record: Record) -> Table:
    """Return the fitted parameters with their bounds and standard deviations."""
    rows = [
        (
            f'{entry["symbol"]}, {entry["unit"]}',
            _number(entry['lower']),
            _number(entry['upper']),
            _number(entry['value']) + (' (at bound)' if entry['at_bound'] else ''),
            _number(entry['frozen'], 4),
            _number(entry['std'], 2),
            '-' if entry['std_given_start'] is None else _number(entry['std_given_start'], 2),
            entry['bounds_from'],
        )
        for entry in record['parameters']
    ]
    ends = sorted({entry['window_end_s'] for entry in record['windows']})
    end = _number(record['score_window_s'][1])
    why = 'from the slowest printed engagement to the end of the run, tenths of a second'
    rows.append(
        ('score window end, s', _number(ends[0]), _number(ends[-1]), end, end, '-', '-', why)
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


def torque_table(record: Record) -> Table:
    """Return torque levels and slopes at the optimum with their standard errors."""
    return Table(
        'Engine torque and reference, with standard errors',
        ('quantity', 'optimum', 'standard error', 'standard error, C_m start held'),
        [
            (
                f'{entry["quantity"]}, {entry["unit"]}',
                _number(entry['value']),
                _number(entry['std'], 2),
                _number(entry['std_given_start'], 2) if entry['std_given_start'] else '-',
            )
            for entry in record['torque_and_slopes']
        ],
    )


def optima_table(title: str, optima: Sequence[Record]) -> Table:
    """Return local optima, one a row."""
    return Table(
        title,
        ('window end, s', 'PI', 'PI loop', 'objective', 'worst, tolerances', *_VALUE_HEADERS),
        [
            (
                _number(one['window_end_s']),
                one['pi_kind'],
                'stable' if one['pi_stable'] else f'grows {one["pi_growth_rate_per_s"]:.2f}/s',
                *_fit_cells(one),
            )
            for one in optima
        ],
    )


def fit_table(record: Record) -> Table:
    """Return what the fit as a whole is like."""
    objective, analysis = record['objective'], record['identifiability']
    weakest = [
        f'{entry["symbol"]} {analysis["weakest"][entry["name"]]:+.2f} {entry["unit"]}'
        for entry in record['parameters']
        if abs(analysis['weakest'][entry['name']]) > 0.1
    ]
    within = [
        _number(one['window_end_s'])
        for one in record['windows']
        if one['pi_stable'] and abs(one['worst_residual']) <= 1.0
    ]
    return Table(
        'The fit as a whole',
        ('quantity', 'value'),
        [
            ('objective at the optimum', f'{objective["value"]:.3f}'),
            ('objective at the frozen values', f'{record["frozen_objective"]:.3f}'),
            ('numbers fitted to', str(objective['numbers'])),
            ('values fitted, window end included', str(objective['fitted'])),
            ('degrees of freedom', str(analysis['degrees_of_freedom'])),
            ('std of a scaled residual', f'{analysis["residual_std"]:.2f}'),
            ('std in half a 95 % interval (Student)', f'{analysis["coverage_95"]:.1f}'),
            ('undetermined together', ', '.join(weakest)),
            ('window ends with a stable fit within all tolerances, s', ', '.join(within)),
        ],
    )


def direction_table(record: Record) -> Table:
    """Return the singular values of the Jacobian with their directions."""
    analysis = record['identifiability']
    return Table(
        'Singular values of the residuals, per range of each parameter, and their directions',
        ('singular value', *_VALUE_HEADERS),
        [
            (_number(value, 3), *(_signed(share, 2) for share in direction))
            for value, direction in zip(
                analysis['singular_values'], analysis['directions'], strict=True
            )
        ],
    )


def correlation_table(record: Record) -> Table:
    """Return the correlations of the parameters with C_m start held."""
    return Table(
        'Correlation of the parameters, C_m start held',
        ('', *_VALUE_HEADERS[1:]),
        [
            (name, *(_signed(value, 2) for value in row))
            for name, row in zip(
                _VALUE_HEADERS[1:],
                record['identifiability']['correlation_given_start'],
                strict=True,
            )
        ],
    )


def left_out_table(record: Record) -> Table:
    """Return what the fits to two rows say about the third."""
    return Table(
        'One row left out',
        ('row', 'figure', 'printed', 'computed', 'deviation, %', 'tolerance, %', 'what it is'),
        [
            (
                *_figure_cells(entry),
                'not predictable: gains fitted to it' if one['gains_from_row'] else 'prediction',
            )
            for one in record['left_out']
            for entry in one['figures']
        ],
    )


def assumption_table(record: Record) -> Table:
    """Return the fits with other assumptions."""
    return Table(
        'Fits with other assumptions',
        ('change', 'objective', 'worst, tolerances', *_VALUE_HEADERS),
        [(one['change'], *_fit_cells(one)) for one in record['assumptions']],
    )


def _figure_cells(entry: Record) -> tuple[str, ...]:
    return (
        ROW_OF[entry['row']].label,
        _FIGURE_LABELS[entry['figure']],
        f'{entry["printed"]:.2f}',
        f'{entry["computed"]:.3f}',
        _signed(100.0 * entry['deviation'], 1),
        _number(100.0 * entry['tolerance']),
    )


def _fit_cells(one: Record) -> tuple[str, ...]:
    forms = ('{:.1f}', '{:.1f}', '{:.3f}', '{:.1f}', '{:.3f}', '{:.4f}')
    return (
        f'{one["objective"]:.3f}',
        _signed(one['worst_residual'], 2),
        *(form.format(one['values'][name]) for form, name in zip(forms, NAMES, strict=True)),
    )


def _number(value: float, digits: int = 4) -> str:
    """Return the value with so many significant digits, without an exponent."""
    rounded = float(f'{value:.{digits - 1}e}')
    return f'{rounded:.0f}' if abs(rounded) >= 10 ** (digits - 1) else f'{rounded:.{digits}g}'


def _signed(value: float, decimals: int) -> str:
    """Return the value with its sign, that of zero positive."""
    return f'{round(value, decimals) + 0.0:+.{decimals}f}'
