# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every packaged drive with the second car and every controller, headless."""

import pytest
from second_car import DRIVES, scored, settings_of

from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.floors import with_least
from ddct_bringup.scores.scored_recording import simulate_and_score
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.registry import own_controller_names

pytestmark = pytest.mark.filterwarnings('ignore::RuntimeWarning')  # a slip of 2000 rpm
TABLE_4_1 = {'mpc1', 'mpc2', 'mpc3'}
"""Designs of the thesis for its own car."""
FAILS = {
    'launch': TABLE_4_1 | {'mpc4'},
    'launch_gentle': TABLE_4_1 | {'mpc4', 'pi'},
    'launch_hill': TABLE_4_1 | {'mpc4', 'mpc4_wear', 'torque_estimator', 'decoupled_pid'},
    'launch_hot': TABLE_4_1 | {'mpc4'},
    'tip_in': TABLE_4_1 | {'mpc4', 'hinf3', 'mpc_preview', 'pedal_mpc'},
    'upshift': {'mpc4', 'mpc4_wear'},
    'upshift_2_3': {'mpc4', 'mpc4_wear'},
    'upshift_full': set[str](),
    'upshift_hot': {'mpc4', 'mpc4_wear'},
    'upshift_light': {'mpc4', 'mpc4_wear'},
}
"""Controllers that do not engage, by drive."""


@pytest.mark.parametrize('drive', DRIVES)
def test_every_run_counts_and_least_jerk_and_all_but_those_of_the_list_engage(
    drive: str,
) -> None:
    runs = {name: scored(drive, name) for name in own_controller_names()}
    assert len(runs) == 30
    assert all(run.valid for run in runs.values())
    assert {name for name, run in runs.items() if run.state != ENGAGED} == FAILS[drive]
    assert runs['least_jerk'].metrics['releases'] == 0


@pytest.mark.parametrize('drive', ['launch', 'launch_gentle', 'launch_hot', 'upshift'])
def test_the_second_car_has_floors(drive: str) -> None:
    plan = RunPlan(settings_of(drive), 'least_jerk', 'headless')
    run = with_least(simulate_and_score(plan, packaged_limits()), packaged_limits())
    over_least = run.scores.metrics['peak_jerk_over_least']
    assert isinstance(over_least, float)
    assert 1.0 <= over_least < 1.6
