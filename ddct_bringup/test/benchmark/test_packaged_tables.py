# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`ddct benchmark --packaged` shows every packaged controller in every case, failures included."""

import io
import json
from collections.abc import Iterator
from contextlib import redirect_stdout
from dataclasses import replace

import pytest
from by_schema import require_schema
from small_benchmark import PACKAGED, shown_runs, use_small_release

from ddct_bringup.benchmark.report.packaged import packaged_tables, packaged_written
from ddct_bringup.benchmark.report.rules import left_open, states_that_count
from ddct_bringup.documents.terminal import text_table
from ddct_bringup.programs import benchmark
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.files.json_records import to_json
from ddct_plant.program import printed_table


@pytest.fixture(scope='module')
def small(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Use the cases and rows of a small release."""
    with pytest.MonkeyPatch.context() as patch:
        use_small_release(tmp_path_factory.mktemp('small'), patch)
        yield


def printed_packaged() -> str:
    """Return what the program prints."""
    stream = io.StringIO()
    with redirect_stdout(stream):
        assert benchmark.main(['--packaged']) == 0
    return stream.getvalue()


@pytest.mark.usefixtures('small')
def test_tables_are_of_all_cases_and_of_each_scenario() -> None:
    tables = packaged_tables()
    assert list(tables) == [
        *('all', 'dominance', 'launch', 'launch_figures', 'launch_hill', 'launch_hill_figures')
    ]
    for name, cases in (('all', 6), ('launch', 3), ('launch_hill', 3)):
        assert {shown_runs(text_table(tables[name]), row) for row in range(len(PACKAGED))} == {
            cases
        }
    figures = text_table(tables['launch_figures'])
    assert [tuple(row[:2]) for row in figures.rows[:4]] == [
        *(('pi', 'P50'), ('pi', 'P95'), ('pi', 'worst'), ('ls8', 'P50'))
    ]
    ls8 = {row[1]: dict(zip(figures.headers, row, strict=True)) for row in figures.rows[3:6]}
    assert float(ls8['worst']['jerk m/s^3']) >= float(ls8['P50']['jerk m/s^3']) > 1.0
    assert 1.0 < float(ls8['P50']['work kJ']) < 20.0


@pytest.mark.usefixtures('small')
def test_the_program_prints_the_tables_what_counts_and_what_stays_open() -> None:
    printed = printed_packaged()
    tables = packaged_tables()
    assert [table.title for table in tables.values() if table.title not in printed] == []
    text = ' '.join(printed.split())
    assert 'dominance is of 6 cases, left out of a pair at most: response 0, peak jerk 0' in text
    rules = packaged_limits().rules
    assert f'locked at the end, but for less than {rules.locked_time:g} s' in text
    assert f'What stays open to gaming: up to {rules.withheld_time:g} s' in text
    assert 'is found in half of the draws alone' in text


@pytest.mark.usefixtures('small')
def test_nothing_is_wider_than_80_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(printed_table, '_REDIRECTED_WIDTH', 80)
    lines = printed_packaged().splitlines()
    assert [line for line in lines if len(line) > 80] == []


def test_the_rules_have_the_thresholds_that_judge() -> None:
    rules = replace(
        packaged_limits().rules, withheld_time=0.123, locked_time=0.456, flare_rad_s=7.89
    )
    states = states_that_count(rules)
    assert '0.123 s' in states['withheld']
    assert '0.456 s' in states['late']
    assert '7.89 rad/s' in states['flared']
    assert 'up to 0.123 s' in left_open(rules)


@pytest.mark.usefixtures('small')
def test_the_program_writes_the_tables(capsys: pytest.CaptureFixture[str]) -> None:
    tables = packaged_tables()
    assert benchmark.main(['--packaged', '--json', '-']) == 0
    written = json.loads(capsys.readouterr().out)
    require_schema('benchmark_packaged', written)
    assert written == to_json(packaged_written(tables))
    for name, table in tables.items():
        assert [list(row.values()) for row in written[name]['rows']] == [
            [*row] for row in text_table(table).rows
        ]


@pytest.mark.parametrize(
    'arguments', [['pi'], ['--out', 'there'], ['--packaged', 'pi'], ['--packaged', '--seed', '1']]
)
def test_controllers_and_a_folder_are_given_together_and_never_with_the_packaged_ones(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert benchmark.main(arguments) == 1
    printed = capsys.readouterr()
    assert printed.out == ''
    (error,) = printed.err.splitlines()
    assert error.startswith('ddct benchmark: ') and '--packaged' in error
