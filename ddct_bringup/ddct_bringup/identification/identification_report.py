# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The identified driveline as JSON and as tables."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ddct_bringup.identification.checks import IdentificationCheck
from ddct_bringup.identification.coefficients import FITTED
from ddct_bringup.identification.fit import CoefficientFit, Identification
from ddct_plant.files.json_records import Inline
from ddct_plant.models.parameters import SYMBOLS_AND_UNITS
from ddct_plant.program.printed_table import print_note, print_tables
from ddct_plant.program.table import UNDEFINED, TextTable, Weight, text_or_dash, with_reasons


@dataclass(frozen=True)
class IdentifiedParameter:
    """One parameter of the driveline with its uncertainty, in SI units."""

    name: str
    """Name of its key in a scenario."""
    symbol: str
    """Symbol in the thesis."""
    value: float
    """Value of the best fit."""
    std: float | None
    """Standard deviation by the rounding of the print; None of a parameter that is not fitted."""
    unit: str
    lowest: float | None
    """Least value that the printed digits allow; None where no driveline fits them all."""
    highest: float | None
    """Largest such value."""


def parameters_of(
    identification: Identification, ranges: np.ndarray | None
) -> list[IdentifiedParameter]:
    """Return every parameter; `ranges` (7, 2) are those of `parameter_ranges`."""
    values = identification.parameters.values()
    std = dict(zip(FITTED, identification.relative_std.tolist(), strict=True))
    ends = {} if ranges is None else dict(zip(FITTED, ranges.tolist(), strict=True))
    return [
        IdentifiedParameter(
            name,
            symbol,
            values[name],
            values[name] * std[name] if name in std else None,
            unit,
            *ends.get(name, (None, None)),
        )
        for name, (symbol, unit) in SYMBOLS_AND_UNITS.items()
    ]


@dataclass(frozen=True)
class CheckEntry:
    """A check of the fit, and whether it passes."""

    check: Inline[IdentificationCheck]
    passed: bool


@dataclass(frozen=True)
class FitEntry:
    """How well the printed coefficients determine the driveline."""

    degrees_of_freedom: int
    chi_square: float
    condition: float
    """Condition number of the weighted Jacobian with respect to the logarithms."""
    weakest_direction: Mapping[str, float]
    """Unit vector of relative changes that moves the coefficients least, by parameter."""


@dataclass(frozen=True)
class IdentificationDocument:
    """Document of `identify --json`."""

    parameters: Sequence[IdentifiedParameter]
    coefficients: Sequence[CoefficientFit]
    checks: Sequence[CheckEntry]
    fit: FitEntry


def document_of(
    identification: Identification,
    parameters: Sequence[IdentifiedParameter],
    checks: Sequence[IdentificationCheck],
) -> IdentificationDocument:
    """Return the document of `--json`."""
    return IdentificationDocument(
        parameters,
        identification.coefficients,
        [CheckEntry(check, check.passed) for check in checks],
        FitEntry(
            identification.degrees_of_freedom,
            identification.chi_square,
            identification.condition,
            _weakest(identification),
        ),
    )


def _weakest(identification: Identification) -> dict[str, float]:
    return dict(zip(FITTED, identification.weakest_direction.tolist(), strict=True))


def print_identification(
    identification: Identification,
    parameters: Sequence[IdentifiedParameter],
    checks: Sequence[IdentificationCheck],
) -> None:
    """Print parameters, coefficients and checks as tables."""
    tables = [
        TextTable(
            'Driveline parameters',
            ('parameter', 'symbol', 'value', 'std', 'lowest', 'highest', 'unit'),
            [
                (
                    row.name,
                    row.symbol,
                    text_or_dash(row.value, '.7g'),
                    text_or_dash(row.std, '.2g'),
                    text_or_dash(row.lowest, '.5g'),
                    text_or_dash(row.highest, '.5g'),
                    row.unit,
                )
                for row in parameters
            ],
            weights=(*(Weight.IDENTIFYING, Weight.USEFUL, Weight.NEEDED, Weight.DETAIL),),
        ),
        TextTable(
            'Printed coefficients',
            ('function', 'coefficient', 'printed', 'computed', 'residual, half-units'),
            [
                (
                    row.transfer_function,
                    row.coefficient,
                    _printed(row),
                    text_or_dash(row.computed, '.7g'),
                    f'{round(row.residual_half_units, 2) + 0.0:+.2f}',
                )
                for row in identification.coefficients
            ],
            weights=(Weight.IDENTIFYING, Weight.IDENTIFYING),
        ),
        TextTable(
            'Checks',
            ('check', 'value', 'lowest', 'highest', 'passed'),
            [
                (
                    row.name,
                    *(text_or_dash(each, '.6g') for each in (row.value, row.lowest, row.highest)),
                    'yes' if row.passed else 'no',
                )
                for row in checks
            ],
        ),
    ]
    print_tables(
        replace(with_reasons(table, _dash_reason), complete='--json FILE') for table in tables
    )
    weakest = ', '.join(
        f'{SYMBOLS_AND_UNITS[name][0]} {share:+.2f}'
        for name, share in _weakest(identification).items()
    )
    print_note(
        f'Condition number {identification.condition:.0f}; least determined together: {weakest} '
        '(relative changes)'
    )


def _printed(row: CoefficientFit) -> str:
    if row.taken == row.printed:
        return row.printed
    return f'{row.printed} (erratum, taken as {row.taken})'


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash, from its column and its row."""
    if header == 'std':
        return 'not fitted'
    if row[-1] in ('yes', 'no'):
        return 'the check has no such limit, or no value'
    fitted = row[3] != UNDEFINED
    return 'no driveline fits all printed digits' if fitted else 'not fitted'
