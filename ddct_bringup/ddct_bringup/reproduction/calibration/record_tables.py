# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of a calibration record, for the terminal and the page of documentation."""

from ddct_bringup.reproduction.calibration.fit_tables import (
    VALUE_HEADERS,
    fit_cells,
    fit_table,
    number,
    optima_table,
    parameter_table,
    residual_table,
    signed,
    torque_table,
    value_cells,
)
from ddct_bringup.reproduction.calibration.record_types import CalibrationRecord, CheckRecord
from ddct_plant.program.table import Table


def all_tables(record: CalibrationRecord) -> dict[str, Table]:
    """Return every table of a whole calibration by name, in reading order."""
    end = number(record.score_window_s[1])
    return {
        'parameters': parameter_table(record),
        'torque_and_slopes': torque_table(record),
        'residuals': residual_table(record.residuals),
        'windows': optima_table('Optima by end of the score window', record.windows),
        'starts': optima_table(f'Optima from every start, window to {end} s', record.starts),
        'fit': fit_table(record),
        'directions': direction_table(record),
        'correlation': correlation_table(record),
        'left_out': left_out_table(record),
        'assumptions': assumption_table(record),
    }


def check_tables(record: CheckRecord) -> list[Table]:
    """Return the tables of a check of the frozen scenario."""
    moves = Table(
        'Local refit from the frozen scenario',
        ('parameter', 'move, % of its range'),
        [(name, signed(100.0 * share, 2)) for name, share in record.moved.items()],
    )
    return [residual_table(record.residuals), moves]


def direction_table(record: CalibrationRecord) -> Table:
    """Return the singular values of the Jacobian with their directions."""
    analysis = record.identifiability
    return Table(
        'Singular values of the residuals, per range of each parameter, and their directions',
        ('singular value', *VALUE_HEADERS),
        [
            (number(value, 3), *(signed(share, 2) for share in direction))
            for value, direction in zip(analysis.singular_values, analysis.directions, strict=True)
        ],
    )


def correlation_table(record: CalibrationRecord) -> Table:
    """Return the correlations of the parameters for a fixed C_m start."""
    return Table(
        'Correlation of the parameters, C_m start held',
        ('', *VALUE_HEADERS[1:]),
        [
            (name, *(signed(value, 2) for value in row))
            for name, row in zip(
                VALUE_HEADERS[1:],
                record.identifiability.correlation_given_start,
                strict=True,
            )
        ],
    )


def left_out_table(record: CalibrationRecord) -> Table:
    """Return the predictions of the third row by fits to two rows."""
    return Table(
        'One row left out',
        ('row', 'figure', 'printed', 'computed', 'deviation, %', 'tolerance, %', 'what it is'),
        [
            (
                *value_cells(entry),
                'not predictable: gains fitted to it' if one.gains_from_row else 'prediction',
            )
            for one in record.left_out
            for entry in one.figures
        ],
    )


def assumption_table(record: CalibrationRecord) -> Table:
    """Return the fits with other assumptions."""
    return Table(
        'Fits with other assumptions',
        ('change', 'objective', 'worst, tolerances', *VALUE_HEADERS),
        [(one.change, *fit_cells(one.fit)) for one in record.assumptions],
    )
