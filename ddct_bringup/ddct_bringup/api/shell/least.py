# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The least values over a grid of lock times, and controllers beside them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.api import shell
from ddct_bringup.documents.document import Document
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
from ddct_bringup.floor.shown import limit_shown
from ddct_bringup.floor.values import Floor
from ddct_bringup.many_runs.engine import each_result
from ddct_bringup.scores.shift_conditions import shift_conditions
from ddct_controllers.registry import Chosen
from ddct_plant.program.progress import with_progress
from ddct_plant.scenario.settings import RunSettings


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
    def written(self) -> LimitDocument:
        """What `--json` writes."""
        return LimitDocument([floor_row(each) for each in self.floors], self.rows, self.capped)

    @property
    def shown(self) -> Document:
        """What the terminal shows: the front, controllers if there are some, and caps."""
        return limit_shown(_title(self.settings), self.floors, self.rows, self.capped)

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
    # Late lock times take longest: with them at first all workers end at about the same time.
    points = front(settings, metrics, times[::-1], start, workers)
    found_last_first = [*with_progress(points, len(times), 'lock times')]
    floors = [floor for point in reversed(found_last_first) for floor in point]

    def rows_of(chosen: Chosen) -> list[ControllerRow]:
        return controller_rows(settings, chosen, metrics, start)

    found = each_result(rows_of, controllers, workers)
    rows = [row for each in with_progress(found, len(controllers), 'controllers') for row in each]
    capped = [least_lock_time(floors, metric, cap) for metric, cap in caps]
    return LeastValues(settings, floors, rows, capped)


def _title(settings: RunSettings) -> str:
    parts = [
        settings.scenario.name,
        f'wear gain {settings.case.wear_gain:g}',
    ]
    return ', '.join([*parts, *shift_conditions(settings).values()])
