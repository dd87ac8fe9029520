# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of the clutch that a solver has from the beginning, and weights of a mean square."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ddct_bringup.floor.objectives import OBJECTIVES, RootMeanSquare
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


def test_the_first_and_the_last_sample_of_a_dose_count_half():
    signals: Any = SimpleNamespace(window=(3, 7))
    dose = OBJECTIVES['daily_vibration_dose']
    assert isinstance(dose, RootMeanSquare)
    weights = dose.weights(signals)
    np.testing.assert_allclose(weights, [0.125, 0.25, 0.25, 0.25, 0.125], rtol=1e-15)
