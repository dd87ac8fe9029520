# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/thesis/predictions.md are those of the studies and support its text."""

import pytest
from generator.pages import as_markdown, shown_tables

from ddct_bringup.reproduction.studies.admissible_scenarios import (
    admissible_scenarios,
    prediction_ranges,
    score_windows,
    worn_ranges,
)
from ddct_bringup.reproduction.studies.study import Study

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def studies() -> dict[str, Study]:
    """Return the studies of the page by name."""
    functions = (admissible_scenarios, prediction_ranges, worn_ranges, score_windows)
    return {function.__name__: function() for function in functions}


def figures(cell: str) -> list[float | None]:
    return [None if part == '-' else float(part) for part in cell.split(' / ')]


def test_page_has_the_tables_of_the_studies(studies):
    """The page has the computed tables; after a change run `make docs KINDS=studies`."""
    shown = shown_tables('studies')
    assert {name: shown[name] for name in studies} == as_markdown(studies)


def test_no_scenario_has_a_whole_predicted_row(studies):
    remarks = studies['prediction_ranges'].remarks[1:]
    assert [remark.split(':')[0] for remark in remarks] == ['MPC3', 'MPC4']
    assert all(' 0 hit all three figures' in remark for remark in remarks)


def test_quiet_before_mpc4_acts_is_as_printed_for_the_frozen_end_of_the_window_only(studies):
    centres = [row for row in studies['score_windows'].rows if row[1] == 'centre']
    near = [row[0] for row in centres if float(row[-1]) == pytest.approx(0.2, rel=0.15)]
    assert near == ['1.7']


def test_window_to_the_end_of_the_run_brings_mpc3_per_rad_s_near_the_print_and_mpc4_off(studies):
    (whole,) = [row for row in studies['score_windows'].rows if row[1] == 'least squares']
    assert whole[0] == '3.0'
    assert float(whole[2]) < 13.5
    time, torsion, acceleration = figures(whole[6])
    assert (time, torsion, acceleration) == pytest.approx((0.63, 0.9, 0.19), rel=0.1)
    mpc4 = figures(whole[7])
    assert mpc4[1] is not None
    assert mpc4[1] > 3.0 * 0.2
