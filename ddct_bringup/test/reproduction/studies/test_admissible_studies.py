# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The studies of the admissible scenarios support the text of docs/thesis/predictions.md."""

import pytest

from ddct_bringup.reproduction.studies.admissible_scenarios import (
    prediction_ranges,
    score_windows,
)
from ddct_bringup.reproduction.studies.study import Study

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def studies() -> dict[str, Study]:
    """Return the studies by name."""
    functions = (prediction_ranges, score_windows)
    return {function.__name__: function() for function in functions}


def figures(cell: str) -> list[float | None]:
    return [None if part == '-' else float(part) for part in cell.split(' / ')]


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
