# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A small slip is engaged after it has stayed within the band for the settled time, not before."""

import numpy as np
import pytest
from made_run import CONTROL_START, RAD_S_PER_RPM, made_run

from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import slip_state

RULES = packaged_limits().rules


@pytest.mark.parametrize('last_rpm', [12.0, -12.0])
def test_a_slip_is_engaged_after_the_settled_time_in_the_band_and_not_a_period_before(last_rpm):
    outside = RULES.engaged_slip / RAD_S_PER_RPM + 20.0
    periods = round(100 * RULES.settled_time)
    drift = np.linspace(1.0, 0.0, periods + 1)  # neither at rest nor oscillating
    slip = np.concatenate([np.linspace(600.0, outside, 100), last_rpm + drift])
    assert slip_state(made_run(slip), CONTROL_START, RULES) == 'engaged'
    assert slip_state(made_run(slip[:-1]), CONTROL_START, RULES) == 'not_engaged'
