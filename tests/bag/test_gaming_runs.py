# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that changes the driver's torque for long does not engage, however it locks."""

from pathlib import Path

import pytest
from support.gaming_runs import gaming_file
from support.independent_figures import independent_figures

from ddct_bringup.api import run
from ddct_bringup.verdict.limits import packaged_limits


@pytest.mark.parametrize(
    ('name', 'state', 'figure'),
    [('withhold_long', 'withheld', 'withheld_s'), ('add_long', 'added', 'added_s')],
)
def test_a_launch_with_half_or_nearly_twice_the_demand_is_not_engaged(
    name: str, state: str, figure: str, tmp_path: Path
) -> None:
    made = run(gaming_file(name), scenario='launch', out=tmp_path)
    assert (made.valid, made.state) == (True, state)
    found = independent_figures(made.path)
    changed_s, delivered = found[figure], found['delivered_at_end']
    rules = packaged_limits().rules
    assert changed_s is not None and changed_s > rules.withheld_time == rules.added_time
    assert found['time_to_final_lock_s'] is not None
    assert delivered == pytest.approx(0.5 if state == 'withheld' else 1.0)
