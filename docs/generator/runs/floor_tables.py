# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table of how close runs of the simulated plant come to their proven floors of peak jerk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.front import front, usual_lock_times
from ddct_bringup.floor.values import Floor
from ddct_controllers.handover.laws import HANDOVERS
from ddct_plant.program.table import UNDEFINED, Table
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

METRIC = 'peak_jerk'
CLOSE, NEAR = 1.0, 10.0
"""Gaps in % up to which a floor counts as reached, and as nearly reached."""
_COLUMNS = (
    'scenario',
    'lock times s',
    f'gap within {CLOSE:g} %',
    f'{CLOSE:g} to {NEAR:g} %',
    f'beyond {NEAR:g} %',
    'no run found',
    f'all within {NEAR:g} % from s',
    'largest gap %',
)


@dataclass(frozen=True)
class Case:
    """A scenario with its clutch and, in a gear shift, its handover."""

    scenario: str
    clutch: str = 'stick_slip'
    handover: str | None = None

    @property
    def label(self) -> str:
        """Name in the table."""
        return f'`{self.scenario}`, ' + (self.handover or self.clutch.replace('_', '-'))

    @property
    def settings(self) -> RunSettings:
        """Settings of its runs."""
        settings = RunSettings(load_scenario(self.scenario), clutch=self.clutch)
        return replace(settings, handover=self.handover) if self.handover else settings


CASES = (
    Case('thesis', 'linear'),
    Case('thesis'),
    Case('launch'),
    Case('launch_hot'),
    Case('launch_gentle'),
    *(Case('upshift', handover=name) for name in HANDOVERS),
)


def floor_tables() -> Mapping[str, Table]:
    """Return the table, with a row for each of `CASES`."""
    with in_processes(lambda index: gap_row(CASES[index]), len(CASES), chunk=1) as found:
        return {'gaps': Table('Gaps', _COLUMNS, list(found))}


def gap_row(case: Case) -> tuple[str, ...]:
    """Return the numbers of the usual lock times by the gap between the floor and a run."""
    settings = case.settings
    start = control_start(settings)
    times = usual_lock_times(settings, start)
    floors = [floor for (floor,) in front(settings, [METRIC], times, start)]
    gaps = [floor.gap for floor in floors if floor.gap is not None]
    close = sum(gap <= CLOSE for gap in gaps)
    near = sum(gap <= NEAR for gap in gaps)
    return (
        case.label,
        f'{times[0]:.2f} to {times[-1]:.2f}',
        str(close),
        str(near - close),
        str(len(gaps) - near),
        str(len(floors) - len(gaps)),
        _near_from(floors),
        f'{max(gaps):.1f}' if gaps else UNDEFINED,
    )


def _near_from(floors: Sequence[Floor]) -> str:
    """Return the least lock time in s from which on all gaps are near."""
    found = UNDEFINED
    for floor in reversed(floors):
        if floor.gap is None or floor.gap > NEAR:
            break
        found = f'{floor.lock_time_s:.2f}'
    return found
