# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Study: a table of closed-loop runs, row by row, and the columns that studies share."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.reproduction.study_run import StudyRun
from ddct_bringup.thesis.table_5_1 import FORMS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.files.json_records import Inline
from ddct_plant.program.table import Quantity, TextColumn, TextTable, Weight, WrittenTable

if TYPE_CHECKING:
    import matplotlib.figure

WEAR_GAINS = (0.7, 1.0, 1.3)
"""Wear gains: the ends of the thesis's Table 5.2, and a new clutch."""
FINER_WEAR_GAINS = (0.7, 0.85, 1.0, 1.15, 1.3)
AS_PRINTED = 'as the thesis prints it'
"""Label of a row of printed values."""
CLOSE_RPM = 10.0
"""
Slip in rpm that counts as close to zero: 2 % of that at control start in the thesis scenario, a
line's width in a plot.
"""


@dataclass(frozen=True)
class WrittenStudy:
    """A study as JSON has it."""

    table: Inline[WrittenTable]
    remarks: Sequence[str]
    """Remarks for its readers."""


@dataclass(frozen=True)
class Study(TextTable):
    """Table with remarks for its readers."""

    remarks: tuple[str, ...] = ()
    draw: 'Callable[[], matplotlib.figure.Figure] | None' = None
    """Function that returns the chart of the study, None without one."""

    @property
    def document(self) -> WrittenStudy:
        """The study as JSON has it."""
        return WrittenStudy(self.written, self.remarks)


StudyFunction = Callable[[], Study]
StudyColumn = TextColumn[StudyRun]


def headers(columns: Sequence[StudyColumn]) -> tuple[str, ...]:
    """Return the headers of the columns."""
    return tuple(column.heading for column in columns)


def cells(columns: Sequence[StudyColumn], run: StudyRun) -> tuple[str, ...]:
    """Return the cells of a run in the columns."""
    return tuple(column.text(run) for column in columns)


def run_study(
    title: str,
    keys: Sequence[str],
    columns: Sequence[StudyColumn],
    cases: Iterable[tuple[tuple[str, ...], StudyRun]],
    remarks: tuple[str, ...] = (),
) -> Study:
    """Return the table with a row per case: its cells below the keys, then the columns."""
    rows = [(*labels, *cells(columns, run)) for labels, run in cases]
    weights = (*identified_by(len(keys)), *(column.weight for column in columns))
    return Study(title, (*keys, *headers(columns)), rows, remarks, weights=weights)


def identified_by(count: int) -> tuple[Weight, ...]:
    """Return the weights of a table whose first columns identify a row."""
    return (Weight.IDENTIFYING,) * count


def dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash in a study, from its column and its row."""
    if any(AS_PRINTED in cell for cell in row):
        return 'the thesis does not print it'
    if header.startswith('growth'):
        return 'C_fOL alone has no feedback'
    reasons = (reason for name, reason in _UNDEFINED.items() if header.endswith(name))
    return next(reasons, 'does not apply to this row')


def close_time_s(trajectory: Trajectory, start: int) -> float | None:
    """Return the time in s from step `start` until |w_d| stays below CLOSE_RPM, None for never."""
    far = np.flatnonzero(np.abs(rpm_from_rad_s(trajectory.slip_speed)) >= CLOSE_RPM)
    last = far[-1] if far.size else -1
    return None if last == trajectory.steps else float(max(last + 1 - start, 0) * PERIOD_S)


def deviation_range(trajectory: Trajectory) -> str:
    """Return the lowest and the highest C_m - demand of a run in N m."""
    deviation = trajectory.engine_torque - trajectory.torque_demand
    return f'{deviation.min():.0f} to {deviation.max():.0f}' if deviation.any() else '0'


def friction_kj(run: StudyRun) -> float | None:
    """Return the friction work of the clutch from control start on in kJ."""
    energy = run.metrics['friction_work_j']
    return None if energy is None else energy / 1000.0


def metric_column(
    quantity: Quantity, form: str, heading: str = '', weight: Weight = Weight.NEEDED
) -> StudyColumn:
    """Return the column of a metric; the heading defaults to its symbol and unit."""
    return TextColumn(
        heading or quantity.heading, form, lambda run: run.metrics[quantity.key], weight=weight
    )


def close_column(header: str) -> StudyColumn:
    """Return the column of `close_time_s`."""
    return TextColumn(
        header,
        '.2f',
        lambda run: close_time_s(run.trajectory, run.start),
        weight=Weight.DETAIL,
    )


TABLE_5_1 = tuple(metric_column(METRICS[name], form) for name, form in FORMS.items())
"""Columns of the metrics of Table 5.1."""
TWO_INPUTS: tuple[StudyColumn, ...] = (
    TABLE_5_1[0],
    close_column(f'|w_d| < {CLOSE_RPM:g} rpm s'),
    *TABLE_5_1[1:],
    metric_column(METRICS['slip_final_rpm'], '.1f', 'w_d at end rpm'),
    TextColumn(
        'C_m - demand N m',
        '',
        lambda run: deviation_range(run.trajectory),
        weight=Weight.USEFUL,
    ),
)
"""Columns for a controller of clutch and engine."""
TWO_INPUT_WEIGHTS = tuple(column.weight for column in TWO_INPUTS)
_UNDEFINED = {
    **{metric.heading: metric.undefined for metric in METRICS.values()},
    **dict.fromkeys(
        (f'|w_d| < {CLOSE_RPM:g} rpm s', f'within {CLOSE_RPM:g} rpm s'),
        f'|w_d| is {CLOSE_RPM:g} rpm or more at the end',
    ),
    'lock s': 'the clutch does not lock, or w_d does not reach zero',
    'peak jerk m/s^3': METRICS['peak_jerk_m_s3'].undefined,
    'friction kJ': METRICS['friction_work_j'].undefined,
    'releases': 'the clutch never locked, or cannot',
    'fit, tolerances': 'w_d does not reach zero with one of the fitted controllers',
    **dict.fromkeys(
        ('w_d, printed', 'w_sr and A_x, printed'), 'the thesis rates no clutch of this wear'
    ),
}
"""Reason of a dash by the end of its header."""
