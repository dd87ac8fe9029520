# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The document of a tuning: the best trial, the front, what decides, convergence, origin."""

from collections.abc import Mapping
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING

from ddct_bringup.benchmark.report.judged_sections import gaps_table
from ddct_bringup.documents.document import (
    Block,
    Cell,
    Column,
    Document,
    Figure,
    Note,
    Remarks,
    Row,
    Section,
    Table,
    Terms,
    given,
)
from ddct_bringup.tuning.report import texts
from ddct_bringup.tuning.report.charts import front_chart, progress_chart, slices_chart
from ddct_bringup.tuning.report.commands import PageCommands
from ddct_bringup.tuning.result import Figures, FrontEntry, TuningResult
from ddct_plant.program.table import Weight

if TYPE_CHECKING:
    from optuna import Study

_NAME = Weight.IDENTIFYING


def tuning_document(
    result: TuningResult,
    study: 'Study | None' = None,
    commands: PageCommands | None = None,
    facts: Mapping[str, str] | None = None,
) -> Document:
    """
    Return the document of a tuning.

    A page also has the charts of its study, the commands for its folder, and its origin.
    """
    return Document(
        'Tuning',
        f'Tuning of {result.controller}',
        f'{result.trials} trials on {result.cases} development cases · '
        f'{", ".join(result.parameters)}',
        given(
            Remarks('Of this tuning', list(texts.notes_of(result))),
            _best(result, commands),
            _front(result, study),
            _decides(result, study),
            _convergence(result, study),
            _trials(result),
            _origin(result, commands, facts),
        ),
    )


def _best(result: TuningResult, commands: PageCommands | None) -> Section:
    best = next(each for each in result.front if each.number == result.best)
    entries = {_label(result, best): best}
    if result.before:
        entries['before'] = result.before
    return Section(
        'The best trial, and before',
        given(
            _use(commands) if commands else None,
            entries_table(result, entries),
            gaps_table(result.gaps, 'figure of the best trial'),
            texts.terms('best', 'development', 'held out', 'gap'),
        ),
        key='best',
        short='Best',
    )


def _use(commands: PageCommands) -> Note:
    others = ', '.join(commands.further_scenarios)
    after = f'The cases also have {others}: give another one to --scenario.' if others else ''
    return Note(
        'Use it at once, in the folder of this page:', commands.compare, after, page_only=True
    )


def entries_table(result: TuningResult, entries: Mapping[str, FrontEntry]) -> Table:
    """Return the figures of trials by label, in development cases and in held-out ones."""
    goals = [*result.objectives, *result.constraints]
    columns = [
        Column('trial', number=False, weight=_NAME),
        Column('cases', number=False, weight=_NAME),
        *(Column(name, form='.4g', weight=Weight.USEFUL) for name in result.parameters),
        *(
            Column(goal.title, goal.unit, goal.form, missing='no run has a value')
            for goal in goals
        ),
        Column('engaged', form='.1%', weight=Weight.USEFUL),
        Column('keeps all', number=False, weight=Weight.USEFUL),
    ]
    rows = [
        (label, cases, *entry.parameters.values(), *_values(result, figures))
        for label, entry in entries.items()
        for cases, figures in (('development', entry.development), ('held out', entry.held_out))
        if figures
    ]
    chosen = [place for place, row in enumerate(rows) if row[0] == _best_label(result)]
    return Table('', columns, rows, chosen)


def _values(result: TuningResult, figures: Figures) -> Row:
    keeps = figures.keeps_constraints
    return (
        *(figures.objectives[goal.name] for goal in result.objectives),
        *(figures.constraints[goal.name] for goal in result.constraints),
        figures.engaged.value,
        Cell('yes' if keeps else 'no', alarming=not keeps),
    )


def _front(result: TuningResult, study: 'Study | None') -> Section:
    if len(result.objectives) == 1:
        return Section('Front', [])
    figures: list[Block] = [
        Figure(
            f'{goals[0].title} and {goals[1].title}',
            partial(front_chart, result, study, *at),
            'Trials over two objectives; the table below has the values of the front',
        )
        for at in combinations(range(len(result.objectives)), 2)
        for goals in [[result.objectives[place] for place in at]]
        if study
    ]
    entries = {_label(result, each): each for each in result.front}
    return Section(
        'Front',
        [*figures, entries_table(result, entries), texts.terms('front')],
        key='front',
    )


def _decides(result: TuningResult, study: 'Study | None') -> Section:
    figures: list[Block] = [
        Figure(
            goal.title,
            partial(slices_chart, result, study, place),
            f'{goal.title} of all trials over each parameter; grey break a constraint',
        )
        for place, goal in enumerate(result.objectives)
        if study
    ]
    return Section(
        'What decides',
        given(
            effects_table(result),
            *figures,
            Note(
                'Trials that break a constraint count the runs until they ended. The highest '
                'tenth is not drawn.',
                page_only=True,
            ),
            texts.terms('importance'),
        ),
        key='sensitivity',
    )


def effects_table(result: TuningResult) -> Table:
    """Return how much each parameter decides each objective."""
    columns = [
        Column('objective', number=False, weight=_NAME, symbols=True),
        Column('parameter', number=False, weight=_NAME),
        Column('importance', form='.2f'),
    ]
    rows = [
        (goal.title, name, share)
        for goal in result.objectives
        for name, share in result.importances[goal.name].items()
    ]
    return Table('', columns, rows)


def _convergence(result: TuningResult, study: 'Study | None') -> Section | None:
    if not study:
        return None
    figure = Figure(
        '',
        partial(progress_chart, result, study),
        'What the trials have reached, over their numbers',
    )
    volume = Note(
        'The hypervolume between the front and the worst values of the trials that keep all '
        'constraints.',
        page_only=True,
    )
    content: list[Block] = [figure] if len(result.objectives) == 1 else [figure, volume]
    return Section('Convergence', content, key='convergence')


def _trials(result: TuningResult) -> Section:
    return Section(
        'Trials',
        given(
            _counts('state', result.states),
            _counts('ended or infeasible by', result.reasons),
            Note(f'{result.runs} of {result.all_runs} runs were computed.'),
            texts.terms('ended early'),
        ),
        key='trials',
        page_only=True,
    )


def _counts(title: str, counts: Mapping[str, int]) -> Table:
    columns = [Column(title, number=False, weight=_NAME), Column('trials', form='d')]
    return Table('', columns, list(counts.items()))


def _origin(
    result: TuningResult, commands: PageCommands | None, facts: Mapping[str, str] | None
) -> Section | None:
    if not commands or not facts:
        return None
    found = {
        **facts,
        'held-out seed': f'{result.held_out_seed}, from the digests of the tuned files and of the '
        'release',
        'check it, in the folder of this page': commands.verify,
    }
    return Section(
        'Origin',
        [Terms(found, facts=True, commands=frozenset({'check it, in the folder of this page'}))],
        key='origin',
        page_only=True,
    )


def _label(result: TuningResult, entry: FrontEntry) -> str:
    return _best_label(result) if entry.number == result.best else str(entry.number)


def _best_label(result: TuningResult) -> str:
    return f'{result.best} (best)'
