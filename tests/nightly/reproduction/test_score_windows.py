# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What the MPC rows of Table 5.1 are with other ends of the score window."""

import pytest

from ddct_bringup.reproduction.studies.admissible_scenarios import score_windows
from ddct_bringup.reproduction.studies.study import Study


@pytest.fixture(scope='module')
def windows() -> Study:
    return score_windows()


def test_quiet_before_mpc4_acts_is_as_printed_for_the_frozen_end_of_the_window_only(windows):
    centres = [row for row in windows.rows if row[1] == 'centre']
    near = [row[0] for row in centres if float(row[-1]) == pytest.approx(0.2, rel=0.15)]
    assert near == ['1.7']


def test_window_to_the_end_of_the_run_brings_mpc3_per_rad_s_near_the_print_and_mpc4_off(windows):
    (whole,) = [row for row in windows.rows if row[1] == 'least squares']
    assert whole[0] == '3.0'
    assert float(whole[2]) < 13.5
    time, torsion, acceleration = figures(whole[6])
    assert (time, torsion, acceleration) == pytest.approx((0.63, 0.9, 0.19), rel=0.1)
    mpc4 = figures(whole[7])
    assert mpc4[1] is not None
    assert mpc4[1] > 3.0 * 0.2


def figures(cell: str) -> list[float | None]:
    return [None if part == '-' else float(part) for part in cell.split(' / ')]
