# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of a tuning for the terminal."""

from collections.abc import Iterator

from ddct_bringup.tuning.report.texts import IMPORTANCES, goal_text, notes_of
from ddct_bringup.tuning.result import FrontEntry, TuningResult
from ddct_plant.program.printed_table import print_note, print_tables
from ddct_plant.program.table import UNDEFINED, Table, Weight, with_reasons


def print_tuning(result: TuningResult) -> None:
    """Print the front with its held-out figures, and what decides the objectives."""
    print_tables(list(_tables(result)))
    for note in notes_of(result):
        print_note(note)


def _tables(result: TuningResult) -> Iterator[Table]:
    goals = [*result.objectives, *result.constraints]
    entries = [(_label(result, each), each) for each in result.front]
    if result.before:
        entries.append(('before', result.before))
    rows = [
        (label, where, *(f'{value:g}' for value in entry.parameters.values()), *cells)
        for label, entry in entries
        for where, figures in (
            ('development', entry.development),
            ('held out', entry.held_out),
        )
        if figures
        for cells in [
            [
                goal_text(goal, figures.objectives if goal.limit is None else figures.constraints)
                for goal in goals
            ]
        ]
    ]
    headers = ('trial', 'cases', *result.parameters, *(each.title for each in goals))
    parameters = len(result.parameters)
    front = Table(
        f'Front of {result.controller}',
        headers,
        rows,
        numbers=_numbers(len(headers)),
        weights=(*[Weight.IDENTIFYING] * 2, *[Weight.USEFUL] * parameters),
        complete='--json FILE',
    )
    yield with_reasons(front, lambda header, row: 'no run has a value')
    decides = [
        (goal.title, name, f'{share:.2f}')
        for goal in result.objectives
        for name, share in result.importances[goal.name].items()
    ]
    if decides:
        weights = [Weight.IDENTIFYING] * 2
        yield Table('What decides', IMPORTANCES, decides, weights=weights)


def _label(result: TuningResult, entry: FrontEntry) -> str:
    best = ' (best)' if entry.number == result.best else ''
    return f'{entry.number}{best}' or UNDEFINED


def _numbers(count: int) -> list[bool]:
    return [place > 1 for place in range(count)]
