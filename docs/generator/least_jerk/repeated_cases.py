# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Development cases of `least_jerk` again: with the highest request, or with another handover."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.rows import CRITERION
from ddct_bringup.campaign.run_set import PlannedRow
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED, FLARED, TIED_UP
from ddct_controllers.handover.laws import HANDOVERS
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.least_jerk.controller import NAME
from ddct_plant.program.table import Table
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.settings import RunSettings
from generator.runs.shift_tables import shift_scenarios

LOCKED_AT_START = 'tip_in'
"""Scenario whose plates are locked at control start."""
HIGHEST_N_M = 1e6
"""
Request with which the clutch carries all that it can within a period of the delay.

Locked plates move the same whatever is requested, and more torque holds them for longer.
"""
_RELEASES = 'releases_after_lock'
_PARTED_HEADERS = ('scenario', 'cases', 'part with the highest request', 'part with `least_jerk`')
_STATES = (ENGAGED, FLARED, TIED_UP)
_HANDOVER_HEADERS = ('handover', 'shifts', *(f'`{state}`' for state in _STATES), 'others')


class Constant(Controller):
    """Requests the same torque in N m at every tick with feedback on."""

    def __init__(self, request: float) -> None:
        """Take the request."""
        super().__init__()
        self._request = request

    def reset(self) -> None:
        """Do nothing."""

    def update(self, measurement: Measurement) -> Command:
        """Return the request less the open loop."""
        return Command(self._request - measurement.open_loop_torque)


def parted_rows() -> list[tuple[str, ...]]:
    """Return the row of the page: cases that part whatever is requested, and with `least_jerk`."""
    rows = release_rows(packaged_folder()).rows.of(NAME)
    runs = locked_cases()
    with in_processes(lambda index: parts(runs[index].settings), len(runs)) as parted:
        unavoidable = sum(parted)
    parted_with_ours = rows[f'{CRITERION}{_RELEASES}'] > 0.0
    ours = int(parted_with_ours[rows[SCENARIO] == LOCKED_AT_START].sum())
    return [(f'`{LOCKED_AT_START}`', str(len(runs)), str(unavoidable), str(ours))]


def parted_table() -> Table:
    """Return the table of cases in which no request keeps locked plates together."""
    return Table('Cases that no request avoids', _PARTED_HEADERS, parted_rows())


def locked_cases() -> list[PlannedRow]:
    """Return the development cases whose plates are locked at control start."""
    rows = release_rows(packaged_folder()).rows.of(NAME)
    return list(_planned(rows[SCENARIO] == LOCKED_AT_START))


def parts(settings: RunSettings) -> bool:
    """Return whether locked plates part with the highest request."""
    run = run_headless(settings, Constant(HIGHEST_N_M))
    results = scored(settings, run).verdict.results
    values = {each.name: each.value for each in results}
    return bool((values[_RELEASES] or 0.0) > 0.0)


def handover_table() -> Table:
    """Return the table of the states of all shifts, with a row for each handover."""
    rows = [handover_row(name) for name in HANDOVERS]
    return Table('Shifts by handover', _HANDOVER_HEADERS, rows)


def handover_row(handover: str) -> tuple[str, ...]:
    """Return the number of shifts of the development cases, and of those in each state."""
    rows = release_rows(packaged_folder()).rows.of(NAME)
    runs = list(_planned(np.isin(rows[SCENARIO], shift_scenarios())))

    def state(index: int) -> str:
        settings = replace(runs[index].settings, handover=handover)
        return scored(settings, run_headless(settings, NAME)).verdict.state

    with in_processes(state, len(runs)) as states:
        counts = Counter(states)
    found = [counts[each] for each in _STATES]
    return (f'`{handover}`', *map(str, (len(runs), *found, len(runs) - sum(found))))


def _planned(chosen: np.ndarray) -> Iterator[PlannedRow]:
    """Yield the runs of the chosen development cases, (cases,) of bool."""
    campaign = Cases.packaged().development([NAME], Path())
    for case in np.flatnonzero(chosen).tolist():
        (run,) = campaign.planned(case, case + 1)
        assert isinstance(run, PlannedRow)
        yield run


def scored(settings: RunSettings, run: Trajectory) -> ScoredRun:
    """Return the scores of a run by the packaged limits."""
    recording = recording_in_memory(settings, 'again', run)
    return score_run(recording, 'again', packaged_limits(), RunTiming())
