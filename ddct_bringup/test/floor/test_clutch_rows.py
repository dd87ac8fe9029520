# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of the clutch that a solver has from the beginning."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ddct_bringup.floor.rows import clutch_rows


@pytest.mark.parametrize('periods', [1, 4, 10, 13])
def test_the_last_ten_slips_before_a_lock_are_limits_from_the_beginning(periods):
    motion: Any = SimpleNamespace(
        sign=1.0,
        slip=np.ones((periods, 2)),
        capacity=np.ones((periods, 6, 2)),
        columns=SimpleNamespace(count=2),
    )
    capacity: Any = SimpleNamespace(most=np.inf)
    deferred = clutch_rows(motion, capacity).deferred
    assert np.flatnonzero(~deferred).tolist() == list(range(max(periods - 10, 0), periods))
