# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The document of a benchmark: each judged controller, all controllers, rules and origin."""

from collections.abc import Iterator

from ddct_bringup.benchmark.report import rules, texts
from ddct_bringup.benchmark.report.judged_sections import judged_sections
from ddct_bringup.benchmark.result_types import JudgedResult, Result
from ddct_bringup.benchmark.update_times import NoUpdateTime, UpdateTimesFile
from ddct_bringup.campaign_report.tables import share_cell
from ddct_bringup.documents.document import (
    Cell,
    Column,
    Document,
    Note,
    Remarks,
    Section,
    Table,
    Terms,
    given,
)
from ddct_bringup.evaluation.quantities import MAIN, QUANTITIES
from ddct_bringup.evaluation.spread import QuantitySummary
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.program.command_line import package_version
from ddct_plant.program.table import Weight

_CHECK = 'check it, in the folder of this page'


def benchmark_document(result: Result, update_times: UpdateTimesFile) -> Document:
    """
    Return the document of a benchmark, whose commands are for its folder.

    Only cells marked `wall` depend on the wall clock.
    """
    return Document(
        'Benchmark',
        f'Benchmark of {", ".join(each.controller for each in result.controllers)}',
        _lead(result),
        given(
            Remarks('Of this benchmark', list(texts.notes_of(result))),
            Remarks('Before you read the tables', list(texts.warnings_of(result)), alarming=True),
            *(section for each in result.judged for section in judged_sections(result, each)),
            _times(update_times),
            _board(result),
            _rules(),
            _origin(result),
        ),
    )


def _lead(result: Result) -> str:
    cases = 'Cases'
    for each in result.judged[:1]:
        if result.development and each.held_out:
            ours, theirs = (
                summary.group(each.controller).runs
                for summary in (result.development, each.held_out)
            )
            cases = f'{ours} development cases and {theirs} held-out cases'
    varied = ', '.join(result.cases.varied)
    return (
        f'{cases} in {len(result.cases.scenarios)} scenarios · {varied} and sensor noise drawn at '
        'random · no single score'
    )


def _times(update_times: UpdateTimesFile) -> Section:
    columns = [
        Column('controller', number=False, weight=Weight.IDENTIFYING),
        Column('over pi', form='.2f'),
        Column('lowest to highest round'),
        Column('median', 'us', '.1f'),
    ]
    rows = [
        (name, *(Cell(None, reason=found.reason, wall=True) for _ in range(3)))
        if isinstance(found, NoUpdateTime)
        else (
            name,
            Cell(found.update_time_over_pi, wall=True),
            Cell(f'{found.lowest_ratio:.2f} to {found.highest_ratio:.2f}', wall=True),
            Cell(found.update_time_median_us, wall=True),
        )
        for name, found in update_times.controllers.items()
    ]
    note = Note(
        'Median time of an update over that of pi, in turn with it on the machine of this '
        'benchmark. It is wall-clock time, so it differs each time, and is not in result.json.',
        page_only=True,
    )
    return Section('Update time', given(note, Table('', columns, rows)), key='times')


def _board(result: Result) -> Section:
    """Return all controllers on the development cases."""
    if not result.development:
        return Section('', [])
    judged = [each.controller for each in result.controllers]
    groups = result.development.groups
    quick = result.cases.quick
    columns = [
        Column('controller', number=False, weight=Weight.IDENTIFYING),
        Column('success', form='.1%'),
        *(
            Column(QUANTITIES[key].symbol, QUANTITIES[key].unit, missing=texts.NO_VALUE)
            for key in MAIN
        ),
        *([] if quick else [Column('dominated by', number=False)]),
    ]
    rows = [
        (
            group.controller,
            share_cell(group.engaged),
            *(_figure(group.quantities.get(key), QUANTITIES[key].form) for key in MAIN),
            *([] if quick else [', '.join(group.dominated_by or ())]),
        )
        for group in groups
    ]
    emphasised = [place for place, group in enumerate(groups) if group.controller in judged]
    rows_of = ' The rows of our controllers came with the release.'
    names = [] if quick else ['better, worse', 'dominates']
    return Section(
        'All controllers on the development cases',
        [
            Note(
                'The figures are P50 of the successes, and below it P95 and the worst.'
                + (rows_of if result.cases.release_rows else '')
            ),
            Table('', columns, rows, emphasised),
            texts.terms('P50, P95, worst', *names),
        ],
        key='board',
        short='All controllers',
        page_only=True,
    )


def _figure(found: QuantitySummary | None, form: str) -> Cell:
    """Return P50 with P95 and the worst below it."""
    if found is None or found.worst_engaged is None:
        return Cell(None)
    p95, worst = found.quantiles.p95, found.worst_engaged.value
    return Cell(found.quantiles.p50, form, below=f'{p95:{form}}, {worst:{form}}')


def _rules() -> Section:
    return Section(
        'What counts',
        [
            Terms(rules.states_that_count(packaged_limits().rules)),
            Note(
                'The five figures, of which less is better, from control start to the end of the '
                'run:',
                page_only=True,
            ),
            Terms(rules.figures_that_count()),
            Section(
                'What nobody gains by',
                [Note(line) for line in rules.NO_GAIN],
                page_only=True,
            ),
            Note(rules.left_open_here()),
        ],
        key='rules',
    )


def _origin(result: Result) -> Section:
    return Section(
        'Origin',
        [Terms(dict(_facts(result)), facts=True, commands=frozenset({_CHECK}))],
        key='origin',
        page_only=True,
    )


def _facts(result: Result) -> Iterator[tuple[str, str]]:
    cases = result.cases
    code = result.release
    yield 'release', f'{code.version}, commit {code.commit}, code {code.code}'
    scenarios = ', '.join(cases.scenarios)
    yield 'cases', f'{cases.samples} samples of each of {scenarios}; digest {cases.digest}'
    yield 'development seed', str(cases.development_seed)
    if rows := cases.release_rows:
        yield (
            'rows of our controllers',
            f'{rows.version}, commit {rows.commit}, code {rows.code}',
        )
    else:
        yield 'car', str(cases.car)
    for judged in result.controllers:
        yield judged.controller, _seed(result, judged)
    yield _CHECK, 'ddct verify .'
    yield 'page made with', f'ddct_bringup {package_version()}'


def _seed(result: Result, judged: JudgedResult) -> str:
    by_judge = result.judge_seed is not None
    origin = 'given by a judge' if by_judge else 'from the digests of controller and release'
    digests = ''.join(f'; {key} {digest}' for key, digest in judged.digests.items())
    return f'held-out seed {judged.held_out_seed}, {origin}{digests}'
