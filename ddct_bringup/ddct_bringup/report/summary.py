"""The tables of scores on the page: Table 5.1 beside ours, and every metric."""

from collections.abc import Sequence
from dataclasses import dataclass

from ddct_bringup.report.runs import ReportRun
from ddct_bringup.scores.comfort import VDV_WEIGHTING
from ddct_bringup.thesis.conditions import is_thesis_run, predicted_range, verdict
from ddct_bringup.thesis.table_5_1 import PREDICTED, ThesisRow, thesis_row


@dataclass(frozen=True)
class MetricColumn:
    """A metric as the page shows it."""

    key: str
    """Name in `scores.json`."""
    symbol: str
    """An underscore begins the index."""
    unit: str
    form: str
    """Format of the number."""
    meaning: str


TABLE_5_1 = (
    MetricColumn('engagement_time_s', 't_a', 's', '.3f', 'Control start to w_d = 0'),
    MetricColumn(
        'torsion_speed_std_rpm',
        'σ w_sr',
        'rpm',
        '.3f',
        'Standard deviation of w_sr over the score window',
    ),
    MetricColumn(
        'acceleration_std_m_s2',
        'σ A_x',
        'm/s²',
        '.3f',
        'Standard deviation of A_x over the score window',
    ),
)
"""The metrics that the thesis prints."""

FURTHER = (
    MetricColumn(
        'slip_rmse_rpm', 'RMSE w_d', 'rpm', '.2f', 'Reference less w_d over the score window'
    ),
    MetricColumn('slip_final_rpm', 'final w_d', 'rpm', '.2f', 'Last sample'),
    MetricColumn(
        'peak_jerk_m_s3',
        'peak jerk',
        'm/s³',
        '.2f',
        'A_x through a 20 Hz low-pass without delay, over the score window',
    ),
    MetricColumn(
        'vdv_m_s1_75',
        'VDV',
        'm/s¹·⁷⁵',
        '.3f',
        f'Vibration dose over the score window, weighted by {VDV_WEIGHTING}',
    ),
    MetricColumn(
        'friction_energy_j', 'friction energy', 'J', '.0f', 'Integral of |C_f w_d|, whole run'
    ),
    MetricColumn(
        'lockup_slip_acceleration_rad_s2',
        'dw_d/dt at lock-up',
        'rad/s²',
        '.2f',
        'Slope of w_d where it first changes its sign',
    ),
    MetricColumn(
        'torque_total_variation_n_m',
        'variation C_f',
        'N m',
        '.0f',
        'Sum of all changes of the torque request, whole run',
    ),
    MetricColumn('steps', 'steps', '', '.0f', 'Periods of 10 ms'),
)
"""The other metrics but those of `timing.json`."""


@dataclass(frozen=True)
class Cell:
    """A metric of one run, with the thesis's figure where it has one."""

    value: float | None
    text: str
    share: float = 0.0
    """Length of the bar, 0 to 1."""
    thesis: float | None = None
    thesis_text: str = ''
    thesis_share: float = 0.0
    """Where the thesis's figure is along the bar."""
    difference: str = ''
    """Ours against the thesis's, signed."""
    spread: str = ''
    """Range over the admissible scenarios, of a predicted figure."""
    verdict: str = ''
    """Hit or miss, of a predicted figure."""


def comparable_rows(runs: Sequence[ReportRun]) -> list[ThesisRow | None]:
    """Return for each run the row of Table 5.1 beside which it may be set."""
    return [
        thesis_row(run.entry['controller'])
        if run.settings is not None and is_thesis_run(run.settings)
        else None
        for run in runs
    ]


def metric_cells(
    column: MetricColumn, runs: Sequence[ReportRun], rows: Sequence[ThesisRow | None]
) -> list[Cell]:
    """Return one cell per run; bars share the scale of the largest figure, ours or printed."""
    values = [run.entry['metrics'][column.key] for run in runs]
    printed = [row if row is not None and column.key in row.figures() else None for row in rows]
    figures = [row.figures()[column.key] for row in printed if row is not None]
    largest = max((abs(value) for value in (*values, *figures) if value is not None), default=0.0)
    return [
        _cell(column, value, row, largest or 1.0)
        for value, row in zip(values, printed, strict=True)
    ]


def _cell(
    column: MetricColumn, value: float | None, row: ThesisRow | None, largest: float
) -> Cell:
    text = '–' if value is None else format(value, column.form)
    share = 0.0 if value is None else abs(value) / largest
    if row is None:
        return Cell(value, text, share)
    thesis = row.figures()[column.key]
    predicted = row.use == PREDICTED
    return Cell(
        value,
        text,
        share,
        thesis,
        f'{thesis:.2f}',
        thesis / largest,
        '' if value is None else f'{100.0 * (value / thesis - 1.0):+.0f} %',
        predicted_range(row.controller, column.key) if predicted else '',
        verdict(row, column.key, value) if predicted else '',
    )
