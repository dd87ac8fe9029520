# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The least values over a grid of lock times, controllers beside them, and their tables."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.front import (
    ControllerRow,
    LeastLockTime,
    LimitDocument,
    controller_rows,
    floor_row,
    front,
    least_lock_time,
    usual_lock_times,
)
from ddct_bringup.floor.lock import counted_from
from ddct_bringup.floor.metric_units import METRICS
from ddct_bringup.floor.values import Floor
from ddct_bringup.many_runs.engine import each_result
from ddct_bringup.scores.shift_conditions import shift_conditions
from ddct_controllers.registry import Chosen
from ddct_plant.program.progress import with_progress
from ddct_plant.program.table import UNDEFINED, TextTable, Weight, text_or_dash, with_reasons
from ddct_plant.scenario.settings import RunSettings

_COMPLETE = '--json FILE'


@dataclass(frozen=True)
class LeastValues:
    """The least value of each metric by lock time, and what controllers have beside it."""

    settings: RunSettings
    floors: Sequence[Floor]
    """Floors of all metrics for each lock time."""
    rows: list[ControllerRow]
    capped: list[LeastLockTime]

    @property
    def impossible(self) -> dict[float, Floor]:
        """Floor of the first metric by lock time, for those that no request leads to."""
        found: dict[float, Floor] = {}
        for floor in self.floors:
            if floor.least is None:
                found.setdefault(floor.lock_time_s, floor)
        return found

    @property
    def any_possible(self) -> bool:
        """Whether a request leads to any of the lock times."""
        return len(self.impossible) < len({floor.lock_time_s for floor in self.floors})

    @property
    def document(self) -> LimitDocument:
        """Document of `--json`."""
        return LimitDocument([floor_row(each) for each in self.floors], self.rows, self.capped)

    @property
    def tables(self) -> list[TextTable]:
        """Tables for the terminal: the front, and controllers if there are some."""
        front_table = with_reasons(_front_table(self.floors), _no_floor)
        if not self.rows:
            return [front_table]
        return [front_table, with_reasons(_controllers_table(self.rows), _no_ratio)]

    @property
    def notes(self) -> list[str]:
        """Notes on the least lock times under caps."""
        return [_capped_note(each) for each in self.capped]

    def draw(self, file: Path) -> None:
        """Write the front as a figure."""
        chart = shell.front_chart(
            self.floors, self.rows, _title(self.settings), counted_from(self.settings)
        )
        shell.write_chart(chart, file)


def least_values(
    settings: RunSettings,
    metrics: Sequence[str],
    lock_times_s: Sequence[float] | None,
    controllers: Sequence[Chosen] = (),
    caps: Sequence[tuple[str, float]] = (),
    *,
    workers: int | None = None,
) -> LeastValues:
    """
    Compute the least values at lock times, the usual ones for None; print the progress.

    `caps` have metrics and values below which a least lock time is searched for. `workers`
    processes share the lock times and the controllers, by default one per core.
    """
    start = control_start(settings)
    times = lock_times_s or usual_lock_times(settings, start)
    points = front(settings, metrics, times, start, workers)
    floors = [
        floor for point in with_progress(points, len(times), 'lock times') for floor in point
    ]

    def rows_of(chosen: Chosen) -> list[ControllerRow]:
        return controller_rows(settings, chosen, metrics, start)

    found = each_result(rows_of, controllers, workers)
    rows = [row for each in with_progress(found, len(controllers), 'controllers') for row in each]
    capped = [least_lock_time(floors, metric, cap) for metric, cap in caps]
    return LeastValues(settings, floors, rows, capped)


def _front_table(floors: Sequence[Floor]) -> TextTable:
    return TextTable(
        'least value of each metric by lock time, and what a run attains',
        ('lock s', 'metric', 'unit', 'least', 'attained', 'gap %', 'proof'),
        [
            (
                f'{floor.lock_time_s:.2f}',
                floor.metric,
                METRICS[floor.metric],
                text_or_dash(floor.least, '.4g'),
                text_or_dash(floor.attained, '.4g'),
                text_or_dash(floor.gap, '.1f'),
                floor.certificate.kind,
            )
            for floor in floors
        ],
        weights=(
            *(Weight.IDENTIFYING, Weight.IDENTIFYING, *[Weight.NEEDED] * 4),
            Weight.DETAIL,
        ),
        complete=_COMPLETE,
    )


def _controllers_table(rows: Sequence[ControllerRow]) -> TextTable:
    return TextTable(
        'controllers, over the least at their own lock time',
        ('controller', 'lock s', 'metric', 'value', 'least', 'over least'),
        [
            (
                row.controller,
                text_or_dash(row.lock_time_s, '.3f'),
                row.metric,
                text_or_dash(row.value, '.4g'),
                text_or_dash(row.least, '.4g'),
                text_or_dash(row.over_floor, '.2f'),
            )
            for row in rows
        ],
        weights=(Weight.IDENTIFYING, Weight.NEEDED, Weight.IDENTIFYING),
        complete=_COMPLETE,
    )


def _capped_note(each: LeastLockTime) -> str:
    found = each.lock_time_s
    text = 'no lock time of the grid' if found is None else f'a lock at {found:g} s'
    before = each.excluded_before_s
    proof = 'proven for none' if before is None else f'impossible before {before:g} s'
    return f'{each.metric} of {each.cap:g} at most: {text}; {proof}'


def _no_floor(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash in the table of the front."""
    *_, least, attained, _, _ = row
    if least == UNDEFINED:
        return 'no torque request locks the plates at that time'
    if least == '0':
        return 'the least is 0'
    return 'no run with that lock was found'


def _no_ratio(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash in the table of controllers."""
    _, lock, _, value, least, _ = row
    if lock == UNDEFINED:
        return 'the clutch does not lock for good'
    if value == UNDEFINED:
        return 'the run has no value of this metric'
    return 'no least is known at that lock time' if least == UNDEFINED else 'the least is 0'


def _title(settings: RunSettings) -> str:
    parts = [
        settings.scenario.name,
        f'wear gain {settings.case.wear_gain:g}',
    ]
    return ', '.join([*parts, *shift_conditions(settings).values()])
