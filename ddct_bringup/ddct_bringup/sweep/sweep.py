# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sweep: every controller at every point of its axes, headless, scored, judged, tabulated."""

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

from ddct_bringup.campaign.rows import (
    RunBase,
    require_suitable,
    result_row,
    scored_headless,
)
from ddct_bringup.scores.csv_text import rows_csv
from ddct_bringup.scores.scoring import Entry
from ddct_bringup.scores.tables import CONTROLLER, STATE, RunColumn, dash_notes, metric
from ddct_bringup.sweep.axis import MOST, Axis, value_text
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.registry import Chosen, controller_label
from ddct_plant.base.errors import ParameterError
from ddct_plant.program.table import Column, Quantity, Table, table_of
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.differences import scenario_title
from ddct_plant.scenario.settings import RunSettings

SCHEMA_VERSION = 1
"""Schema version of the output of `ddct sweep --json`."""
OVER = 'over'
"""Key in a run's entry of the values by the keys of the axes."""


@dataclass(frozen=True)
class Sweep:
    """Runs of a sweep: controllers and settings, checked when built."""

    base: RunBase
    axes: Sequence[Axis]
    controllers: Sequence[Chosen]
    limits: Limits

    def __post_init__(self) -> None:
        """Build the settings of every point, and every controller at the first; DdctError."""
        keys = [axis.key for axis in self.axes]
        for key in keys:
            if keys.count(key) > 1:
                raise ParameterError(f'--over names {key} twice: name each key once')
        if len(self.points) > MOST:
            raise ParameterError(
                f'--over gives {len(self.points)} points: at most {MOST}, `ddct campaign` is '
                'made for more'
            )
        first = self.settings[0]
        if not first.lockstep:
            raise ParameterError(
                f'mode is {first.mode}, but a sweep needs no graph: leave the mode out'
            )
        for controller in self.controllers:
            require_suitable(controller, first)

    @cached_property
    def points(self) -> list[dict[str, Any]]:
        """Every combination of the axes' values, the last axis fastest."""
        keys = [axis.key for axis in self.axes]
        values = product(*(axis.values for axis in self.axes))
        return [dict(zip(keys, point, strict=True)) for point in values]

    @cached_property
    def settings(self) -> list[RunSettings]:
        """Settings of every point."""
        return [self.base.at(point) for point in self.points]

    @property
    def conditions(self) -> str:
        """Common conditions of all runs as a heading: scenario, architecture, clutch, wear."""
        settings = self.settings[0]
        changes = [f'{key}={value}' for key, value in self.base.changes.items()]
        swept = [axis.key for axis in self.axes]
        shared = {
            'architecture': settings.architecture,
            'clutch': f'{settings.clutch} clutch',
            'wear_gain': f'wear gain {settings.wear_gain:g}',
        }
        kept = ', '.join(text for key, text in shared.items() if key not in swept)
        return '; '.join(filter(None, (scenario_title(settings.scenario.name, changes), kept)))

    @property
    def varied(self) -> str:
        """Varied keys, for a heading."""
        return f'over {", ".join(axis.key for axis in self.axes)}'

    def __len__(self) -> int:
        """Return the number of runs."""
        return len(self.controllers) * len(self.points)

    def run(self, index: int) -> Entry:
        """
        Carry out one run; those of the first controller come first.

        Its entry is that of `scores.json`, with its values under `OVER` instead of a bag.
        """
        controller, point = divmod(index, len(self.points))
        entry = scored_headless(self.settings[point], self.controllers[controller], self.limits)
        del entry['bag']
        return {OVER: self.points[point], **entry}

    def runs(self) -> AbstractContextManager[Iterator[Entry]]:
        """Carry out all runs on all cores as the iterator is consumed, see `in_processes`."""
        return in_processes(self.run, len(self))


def sweep_document(sweep: Sweep, runs: Sequence[Entry]) -> dict[str, Any]:
    """Return the document of `--json`: the axes, the limits, and a row per run."""
    return {
        'schema_version': SCHEMA_VERSION,
        'over': [
            {'key': axis.key, 'unit': axis.unit, 'values': list(axis.values)}
            for axis in sweep.axes
        ],
        'controllers': [controller_label(each) for each in sweep.controllers],
        'limits': sweep.limits.origin,
        'rows': list(runs),
    }


def sweep_csv(runs: Sequence[Entry]) -> str:
    """Return the text of `--csv`: a row per run, with the columns of a campaign."""
    return rows_csv([result_row(run, run[OVER]) for run in runs])


def sweep_table(sweep: Sweep, runs: Sequence[Entry], metrics: Sequence[Quantity]) -> Table:
    """Return the table with a row per run: controller, varied values, metrics and state."""
    title = f'{sweep.conditions}; {sweep.varied}'
    columns = [CONTROLLER, *map(_place, sweep.axes), *map(metric, metrics), STATE]
    return table_of(title, columns, runs)


def _place(axis: Axis) -> RunColumn:
    heading = f'{axis.key}\n{axis.unit}' if axis.unit else axis.key
    return Column(heading, '', lambda run: value_text(run[OVER][axis.key]), number=axis.numeric)


def sweep_notes(runs: Sequence[Entry], metrics: Sequence[Quantity]) -> list[str]:
    """Return notes on dashes, and on invalid runs with their values, as `wear_gain=0.7`."""
    failed: dict[str, list[str]] = {}
    for run in runs:
        if not run['valid']:
            reason = f'{run["controller"]} is not valid: {run["reason"]}'
            place = ', '.join(f'{key}={value_text(value)}' for key, value in run[OVER].items())
            failed.setdefault(reason, []).append(place)
    notes = [f'{reason} (at {"; ".join(places)})' for reason, places in failed.items()]
    return [*dash_notes(runs, [metric(each) for each in metrics]), *notes]
