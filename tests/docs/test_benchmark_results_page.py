# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The pages show the rows of the release: of every packaged controller, failures included."""

import pytest
from generator.least_jerk.distance_table import over_the_least
from generator.least_jerk.least_jerk_tables import development_rows
from generator.least_jerk.price_of_limits import PLANS, price_row
from generator.least_jerk.repeated_cases import (
    HIGHEST_N_M,
    Constant,
    handover_row,
    locked_cases,
    parted_rows,
)
from generator.pages import as_markdown, rows_of, shown_tables
from generator.runs.benchmark_tables import benchmark_tables, dominated_by

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import packaged_folder
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import own_controller_names


def test_the_tables_are_those_of_the_rows_of_the_release() -> None:
    assert shown_tables('benchmark') == as_markdown(benchmark_tables()), (
        'run: make docs KINDS=benchmark'
    )


def test_every_controller_stands_in_every_table_with_all_its_runs() -> None:
    names = [f'`{name}`' for name in own_controller_names()]
    for name, text in shown_tables('benchmark').items():
        rows = rows_of(text)
        assert [row[0] for row in rows] == names
        among = 330 if name == 'all' else 30
        for row in rows:
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
        'pi': '`least_jerk`',
        'least_jerk': '',
    }


@pytest.mark.slow
def test_the_cases_that_no_request_avoids_are_those_of_the_page() -> None:
    shown = [tuple(row) for row in rows_of(shown_tables('least-jerk')['unavoidable'])]
    assert shown == parted_rows(), 'run: make docs KINDS=least-jerk'


@pytest.mark.slow
def test_the_states_of_shifts_with_another_handover_are_those_of_the_page() -> None:
    shown = {row[0]: tuple(row) for row in rows_of(shown_tables('least-jerk')['handovers'])}
    assert shown['`model`'] == handover_row('model'), 'run: make docs KINDS=least-jerk'


def test_the_highest_request_leaves_no_clutch_more_to_give() -> None:
    """So a bound with it holds for every request."""
    (run, *_) = locked_cases()
    torques = [
        run_headless(run.settings, Constant(request)).clutch_torque.tobytes()
        for request in (HIGHEST_N_M, 1000.0 * HIGHEST_N_M)
    ]
    assert torques[0] == torques[1]


def test_the_distance_from_the_least_is_that_of_a_run() -> None:
    shown = {row[0]: row[1:] for row in rows_of(shown_tables('least-jerk')['distance'])}
    for scenario in ('launch', 'upshift_2_3'):
        assert shown[f'`{scenario}`'][0] == over_the_least(scenario, {}), (
            'run: make docs KINDS=least-jerk'
        )


@pytest.mark.parametrize('place', [0, len(PLANS) - 1])
def test_the_price_of_lower_limits_is_that_of_runs(place: int) -> None:
    shown = [tuple(row) for row in rows_of(shown_tables('least-jerk')['price'])]
    assert shown[place] == price_row(*PLANS[place]), 'run: make docs KINDS=least-jerk'


def test_the_page_of_least_jerk_has_its_rows() -> None:
    shown = [tuple(row) for row in rows_of(shown_tables('least-jerk')['development'])]
    assert shown == development_rows(), 'run: make docs KINDS=least-jerk'
