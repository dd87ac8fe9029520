# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table 5.2 in numbers, for a run that failed."""

from ddct_bringup.reproduction.studies.table_5_2 import rows_of


def test_a_run_that_does_not_engage_has_no_good_rating_however_small_its_oscillations_are():
    rows = {row[2]: row for row in rows_of('thesis_sticking', 0.7)}
    stillest = min(rows, key=lambda name: float(rows[name][4]))
    assert (stillest, rows[stillest][6]) == ('mpc4', 'not_engaged')
    assert rows['mpc4'][7:10] == ('bad', 'bad', 'bad')
    assert rows['hinf2'][7:10] == ('good', 'average', 'good')
