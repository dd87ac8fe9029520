# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""On other kernels of linear algebra numbers are compared within a bound, and pages are not."""

import json
from pathlib import Path

import pytest
from verified import (
    copied,
    edit_rows,
    make_runs,
    make_small_campaign,
    states,
    verified_on_other_kernels,
)

from ddct_bringup.campaign.conduct import RESULTS


@pytest.mark.parametrize(('change', 'state'), [(0.0, 'same_within'), (1e-5, 'different')])
def test_on_other_kernels_an_edited_row_is_beyond_the_bound(
    tmp_path: Path, change: float, state: str
) -> None:
    folder = copied(make_small_campaign(tmp_path / 'whole'), tmp_path / 'there')
    edit_rows(folder, 'slip_final_rpm', lambda values: [(1.0 + change) * x for x in values])
    done = verified_on_other_kernels(folder)
    assert states(json.loads(done.stdout))[RESULTS] == state, done.stderr


def test_other_kernels_of_linear_algebra_are_named_with_the_bound(tmp_path: Path) -> None:
    done = verified_on_other_kernels(make_runs(tmp_path / 'runs'))
    assert done.returncode == 3, done.stderr
    document = json.loads(done.stdout)
    assert document['bound'] == 1e-9
    assert any('kernel' in each for each in document['environment_differences'])
    found = states(document)
    assert {found[name] for name in ('pi', 'mpc3')} == {'same_within'}
    assert found['report.html'] == 'not_repeated'
    assert all(run['largest_difference'] < 1e-9 for run in document['runs'])
