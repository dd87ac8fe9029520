# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the packaged tunings, from the `front.json` that `ddct tune` wrote for each."""

from collections.abc import Iterator, Mapping

from ddct_bringup.tuning.report.texts import IMPORTANCES, goal_text
from ddct_bringup.tuning.result import FrontEntry, TuningResult
from ddct_bringup.tuning.specification.packaged_specs import packaged_specs
from ddct_plant.files.json_records import read_json
from ddct_plant.program.table import Table
from generator.pages import DOCS

FOLDER = DOCS / 'examples' / 'tuning'
"""Folder with the results, by the names of the specifications."""


def tuning_tables() -> Mapping[str, Table]:
    """Return the front and the effects of each packaged tuning."""
    found = {}
    for name in packaged_specs():
        result = read_json(TuningResult, FOLDER / f'{name}.json')
        found[name] = _front(result)
        found[f'{name}_effects'] = _effects(result)
    return found


def _front(result: TuningResult) -> Table:
    """Return the ends of the front, its best trial, and the values from before."""
    goals = [*result.objectives, *result.constraints]
    headers = ('trial', 'cases', *result.parameters, *(goal.title for goal in goals))
    rows = []
    for label, entry in _entries(result):
        for cases, figures in (
            ('development', entry.development),
            ('held out', entry.held_out),
        ):
            if figures:
                values = {**figures.objectives, **figures.constraints}
                cells = [goal_text(goal, values) for goal in goals]
                given = [f'{value:.4g}' for value in entry.parameters.values()]
                rows.append((label, cases, *given, *cells))
    return Table(f'Front of {result.controller}', headers, rows)


def _entries(result: TuningResult) -> Iterator[tuple[str, FrontEntry]]:
    front = result.front
    if result.before:
        yield 'before', result.before
    for entry in front:
        if entry.number == result.best:
            yield f'{entry.number}, best', entry
        elif entry in (front[0], front[-1]):
            yield f'{entry.number}, end of the front', entry


def _effects(result: TuningResult) -> Table:
    rows = [
        (goal.title, name, f'{share:.2f}')
        for goal in result.objectives
        for name, share in result.importances[goal.name].items()
    ]
    return Table(f'What decides, {result.controller}', IMPORTANCES, rows)
