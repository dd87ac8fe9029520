# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of packaged controllers are the same on other kernels of OpenBLAS, as `verify` compares."""

import numpy as np
import pytest
from kernel_rows import CAMPAIGN, pairs, rows_here, rows_on

from ddct_bringup.digests.processor import this_processor
from ddct_bringup.verification.comparison import BOUND
from ddct_bringup.verification.rounding_bound import LARGEST


@pytest.mark.slow
def test_every_controller_has_the_same_row_on_other_kernels_within_its_bound() -> None:
    here = this_processor().get('kernels of numpy')
    if here is None:
        pytest.skip('numpy has no OpenBLAS of its own here')
    other = 'Prescott' if here != 'Katmai' else 'Nehalem'
    cases = np.random.default_rng(25).integers(CAMPAIGN.cases, size=len(CAMPAIGN.labels))
    indices = [number * CAMPAIGN.cases + int(case) for number, case in enumerate(cases)]
    theirs = rows_on(other, indices)
    found = list(pairs(indices, rows_here(indices), theirs))
    assert any(each.difference > 0.0 for each in found)  # otherwise the kernels are the same
    wrong = [
        CAMPAIGN.labels[each.run // CAMPAIGN.cases]
        for each in found
        if each.difference > each.bound
    ]
    assert not wrong
    assert sum(each.bound == BOUND for each in found) > len(found) / 2
    assert all(each.bound <= LARGEST for each in found)
