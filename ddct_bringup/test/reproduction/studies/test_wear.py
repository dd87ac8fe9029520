# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Columns of the study of wear."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from ddct_bringup.reproduction.studies.wear import _largest_in_last_part


def test_the_largest_slip_is_that_of_the_last_half_second_to_either_side():
    slip_rpm = np.zeros(300)
    slip_rpm[[249, 250, 299]] = 90.0, -7.0, 5.0
    run: Any = SimpleNamespace(slip_rpm=slip_rpm)
    assert _largest_in_last_part(run) == 7.0
