# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of the floors has the gaps that its scenarios have."""

from generator.pages import rows_of, shown_tables
from generator.runs.floor_tables import CASES, gap_row

SHOWN = rows_of(shown_tables('floors')['gaps'])
MAKE = 'run: make docs KINDS=floors'


def test_the_page_has_a_row_of_each_scenario_for_15_lock_times() -> None:
    assert [row[0] for row in SHOWN] == [case.label for case in CASES], MAKE
    assert all(sum(map(int, row[2:6])) == 15 for row in SHOWN)


def test_a_row_is_what_the_floors_of_its_scenario_give() -> None:
    assert SHOWN[0] == gap_row(CASES[0]), MAKE
