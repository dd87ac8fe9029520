# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`ddct benchmark --packaged` shows every packaged controller in every case, failures included."""

import json

import pytest

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import packaged_folder
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.benchmark.report.packaged import dominated_by, packaged_tables
from ddct_bringup.programs import benchmark
from ddct_controllers.registry import own_controller_names


def test_every_controller_stands_in_every_table_with_all_its_runs() -> None:
    for name, table in packaged_tables().items():
        assert [row[0] for row in table.rows] == own_controller_names()
        among = 330 if name == 'all' else 30
        for row in table.rows:
            others = (
                0 if row[2] == '-' else sum(int(each.split()[0]) for each in row[2].split(','))
            )
            assert int(row[1].split()[0]) + others == among


def test_a_controller_that_fails_is_dominated_by_one_that_does_not() -> None:
    rows = release_rows(packaged_folder()).rows.only(['pi', 'least_jerk'])
    assert dominated_by(CaseRows(rows.controllers, rows.columns)).keys() == {'pi', 'least_jerk'}
    columns = {name: column.copy() for name, column in rows.columns.items()}
    for name, column in columns.items():
        column[0] = column[1]
        if name == 'verdict_state':
            column[0] = 'runaway'
    assert dominated_by(CaseRows(rows.controllers, columns)) == {
        'pi': 'least_jerk',
        'least_jerk': '',
    }


def test_the_program_prints_the_tables_and_writes_them(capsys: pytest.CaptureFixture[str]) -> None:
    tables = packaged_tables()
    assert benchmark.main(['--packaged']) == 0
    printed = capsys.readouterr().out
    assert [table.title for table in tables.values() if table.title not in printed] == []
    assert benchmark.main(['--packaged', '--json', '-']) == 0
    written = json.loads(capsys.readouterr().out)
    assert written == {name: table.as_dict() for name, table in tables.items()}
    for name, table in tables.items():
        assert [list(row.values()) for row in written[name]['rows']] == [*map(list, table.rows)]


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
