# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""On other kernels of linear algebra runs and rows are compared with a bound of their own."""

import json
from pathlib import Path

import pytest
from verified import (
    RIPPLED,
    copied,
    edit_rows,
    make_bag,
    make_runs,
    make_small_campaign,
    states,
    verified_on_other_kernels,
)

ROWS = 'ls8: rows 0 to 1'


@pytest.mark.parametrize(
    ('ripple_n_m', 'code', 'state'), [(1e-6, 0, 'same_within'), (10.0, 1, 'different')]
)
def test_a_run_that_amplifies_rounding_has_a_bound_of_its_own(
    ripple_n_m: float, code: int, state: str, tmp_path: Path
) -> None:
    file = tmp_path / 'rippled.py'
    file.write_text(RIPPLED.format(ripple_n_m=ripple_n_m), encoding='utf-8')
    done = verified_on_other_kernels(
        make_bag(tmp_path / 'runs', '--controller', str(file)) / 'Rippled'
    )
    assert done.returncode == code, done.stderr
    (run, *_) = json.loads(done.stdout)['runs']
    assert (run['state'], run['bound'] > 1e-9) == (state, code == 0)
    assert run['largest_difference'] > 1e-9


@pytest.mark.parametrize(('change', 'state'), [(0.0, 'same_within'), (1e-5, 'different')])
def test_on_other_kernels_an_edited_row_is_beyond_the_bound_that_is_measured_for_it(
    tmp_path: Path, change: float, state: str
) -> None:
    folder = copied(make_small_campaign(tmp_path / 'whole'), tmp_path / 'there')
    edit_rows(folder, 'slip_final_rpm', lambda values: [(1.0 + change) * x for x in values])
    done = verified_on_other_kernels(folder)
    assert states(json.loads(done.stdout))[ROWS] == state, done.stderr


def test_other_kernels_of_linear_algebra_are_named_with_the_bound(tmp_path: Path) -> None:
    done = verified_on_other_kernels(make_runs(tmp_path / 'runs'))
    assert (done.returncode, done.stderr) == (0, '')
    document = json.loads(done.stdout)
    assert document['bound'] == 1e-9
    assert any('kernels of numpy' in each for each in document['environment_differences'])
    assert {states(document)[name] for name in ('pi', 'mpc3')} == {'same_within'}
    assert all(run['largest_difference'] < 1e-9 for run in document['runs'])
