"""The table that `compare` prints: our scores beside Table 5.1 of the thesis."""

from collections.abc import Sequence
from typing import TextIO

from ddct_bringup.scores.scoring import Entry
from ddct_bringup.scores.tables import (
    ACCELERATION_STD,
    CONTROLLER,
    ENGAGEMENT_TIME,
    FINAL_SLIP,
    PEAK_JERK,
    TORSION_STD,
    UNDEFINED,
    VALID,
    Column,
    print_runs,
)
from ddct_bringup.scores.thesis_table import thesis_row
from ddct_plant.run_settings import RunSettings

_NOTE = (
    'thesis: Table 5.1. calibrated: this scenario was fitted to the row, so its agreement is a '
    'fit residual;\npredicted: the row took no part in the fit.'
)
_NO_CROSSING = "t_a '-': after control start w_d never changed its sign."


def print_comparison(
    runs: Sequence[Entry], settings: RunSettings, overrides: Sequence[str], stream: TextIO
) -> None:
    """
    Print one row per run.

    The thesis's figures are shown for its own conditions only: its scenario unchanged, the
    detailed architecture, a new clutch.
    """
    like_thesis = (
        settings.scenario.name == 'thesis'
        and not overrides
        and settings.architecture == 'detailed'
        and settings.wear_gain == 1.0
    )
    columns = [CONTROLLER, ENGAGEMENT_TIME, TORSION_STD, ACCELERATION_STD]
    if like_thesis:
        columns = [
            CONTROLLER,
            ENGAGEMENT_TIME,
            _thesis('s', 'engagement_time_s'),
            TORSION_STD,
            _thesis('rpm', 'torsion_speed_std_rpm'),
            ACCELERATION_STD,
            _thesis('m/s^2', 'acceleration_std_m_s2'),
            Column('thesis row', _use, number=False),
        ]
    print_runs(runs, [*columns, FINAL_SLIP, PEAK_JERK, VALID], stream, _title(settings, overrides))
    if like_thesis and any(thesis_row(run['controller']) for run in runs):
        print(_NOTE, file=stream)
    if any(run['valid'] and run['metrics']['engagement_time_s'] is None for run in runs):
        print(_NO_CROSSING, file=stream)


def _title(settings: RunSettings, overrides: Sequence[str]) -> str:
    changes = f' ({", ".join(overrides)})' if overrides else ''
    return (
        f'{settings.scenario.name}{changes}, {settings.architecture}, {settings.clutch} clutch, '
        f'wear gain {settings.wear_gain:g}, {settings.mode}'
    )


def _thesis(unit: str, metric: str) -> Column:
    def text(run: Entry) -> str:
        row = thesis_row(run['controller'])
        return f'{row.figures()[metric]:.2f}' if row else UNDEFINED

    return Column(f'thesis\n{unit}', text)


def _use(run: Entry) -> str:
    row = thesis_row(run['controller'])
    return row.use if row else UNDEFINED
