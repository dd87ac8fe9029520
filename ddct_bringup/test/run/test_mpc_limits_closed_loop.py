# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Limits of the predictive controllers in the loop: their priorities, and soft limits."""

from functools import cache

import numpy as np
import pytest
from samples import sampled
from tight_tolerance import tight_tolerance_run

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

START = load_scenario('thesis').control_start_step
AS_DRAWN = ('mpc1', 'mpc2', 'mpc3')
FULL_INFORMATION = ('measured=speeds', 'load_known=true', 'delay_in_model=true', 'preview=true')
"""Changes that give the three controllers the information of `mpc_preview`."""
ONE_INPUT = (*AS_DRAWN, 'mpc_preview', 'mpc_offset_free', 'mpc_torsion', 'mpc_wear')


@cache
def run(
    name: str, *options: str, changes: tuple[str, ...] = (), wear_gain: float = 1.0
) -> Trajectory:
    given = [*changes, *(f'controllers.{name}.{option}' for option in options)]
    settings = RunSettings(
        KnownSettings(load_scenario('thesis', given)), CaseSettings(wear_gain=wear_gain)
    )
    return run_headless(settings, name)


def with_full_information(name: str) -> tuple[str, ...]:
    return FULL_INFORMATION if name in AS_DRAWN else ()


def solver_states(trajectory: Trajectory) -> set[str]:
    return {dict(status)['qp_status'] for status in trajectory.status[START:]}


@pytest.mark.parametrize('name', sampled(PREDICTIVE, every=2))
def test_limits_that_contradict_each_other_at_control_start(name):
    """C_fOL is 271 N m there: down to 150 N m at 150 N m/s, and no solver is at a loss."""
    limited = run(name, 'highest_torque_n_m=150', 'torque_rate_n_m_s=150')
    requests = limited.torque_request[START - 1 :]
    assert requests[0] > 270.0
    assert np.abs(np.diff(requests)).max() <= 1.5 + 1e-6
    way = int(np.ceil((requests[0] - 150.0) / 1.5))
    assert requests[: way + 1] == pytest.approx(
        np.maximum(requests[0] - 1.5 * np.arange(way + 1), 150.0), abs=1e-4
    )
    assert requests[way:].max() <= 150.0 + 1e-6
    assert solver_states(limited) == {'solved'}


def test_the_rate_counts_from_the_request_to_the_actuator():
    """C_fOL is below 0 on this slope without engine torque, and the actuator gives 0."""
    downhill = ('load.slope_rad=-0.1', 'engine.torque_n_m=[0,0]', 'engine.time_s=[0,1]')
    limited = run('mpc3', 'torque_rate_n_m_s=300', changes=downhill)
    assert limited.torque_request[START - 1] < -3.0
    given = np.maximum(limited.torque_request[START - 1 :], 0.0)
    assert np.abs(np.diff(given)).max() <= 3.0 + 1e-6
    assert limited.torque_request[START:].min() >= -1e-9
    assert solver_states(limited) == {'solved'}


@pytest.mark.parametrize('name', sampled(ONE_INPUT, every=2))
def test_the_plates_do_not_pass_each_other(name):
    """Free, the slip goes 2 to 7 rpm below zero; the soft limit leaves a tenth of an rpm."""
    told = with_full_information(name)
    free, kept = run(name, *told), run(name, *told, 'lowest_slip_rpm=0')
    lowest = [rpm_from_rad_s(each.slip_speed[START:].min()) for each in (free, kept)]
    assert -7.0 < lowest[0] < -2.0
    assert lowest[1] > -0.15
    assert abs(rpm_from_rad_s(kept.slip_speed[-1])) < 0.1
    assert solver_states(kept) == {'solved'}


@pytest.mark.parametrize(
    ('option', 'below'),
    [((), 6.6), (('lowest_slip_rpm=0',), 0.1)],
)
def test_the_plates_pass_each_other_as_far_as_in_scipy(option, below):
    """Both agree within 0.01 rpm with scipy's integration of the loop to 1e-10."""
    given = [f'controllers.mpc_preview.{each}' for each in option]
    integrated = tight_tolerance_run(
        RunSettings(KnownSettings(load_scenario('thesis', given))), 'mpc_preview'
    )
    expected = rpm_from_rad_s(integrated['w_d'][START:].min())
    lowest = rpm_from_rad_s(run('mpc_preview', *option).slip_speed[START:].min())
    assert lowest == pytest.approx(expected, abs=0.01)
    assert round(-expected, 1) == below


def test_the_slip_of_mpc3_crosses_zero_at_a_limit_of_2_rpm_below_but_not_at_zero():
    """The controller has no t_a at a limit of 0, as on its page."""
    at_zero, below = (
        run('mpc3', f'lowest_slip_rpm={limit}').slip_speed[START:].min() for limit in (0, -2)
    )
    assert at_zero > 0.0
    assert -2.0 <= rpm_from_rad_s(below) < 0.0


@pytest.mark.parametrize('name', AS_DRAWN)
def test_a_limit_of_the_predicted_slip_is_as_good_as_the_prediction(name):
    """C_load is unknown to it, which leaves 4.9 to 5.7 rpm of slip (`test_mpc_closed_loop`)."""
    free, kept = run(name), run(name, 'lowest_slip_rpm=50')
    off = rpm_from_rad_s(free.slip_speed[-1])
    assert abs(rpm_from_rad_s(kept.slip_speed[START:].min()) - 50.0) < 1.1 * off
    assert solver_states(kept) == {'solved'}


@pytest.mark.parametrize('name', sampled(PREDICTIVE, every=2))
def test_a_lowest_slip_above_the_reference_is_kept_by_its_weight(name):
    """The limit keeps the slip up although the reference goes to zero."""
    kept = run(name, *with_full_information(name), 'lowest_slip_rpm=50')
    assert rpm_from_rad_s(kept.slip_speed[START:].min()) == pytest.approx(50.0, abs=0.5)
    assert solver_states(kept) == {'solved'}


@pytest.mark.parametrize('name', ['mpc_wear', 'mpc4_wear'])
def test_the_lowest_slip_is_that_of_the_worn_clutch(name):
    kept = run(name, 'lowest_slip_rpm=50', wear_gain=0.7)
    assert rpm_from_rad_s(kept.slip_speed[START:].min()) == pytest.approx(50.0, abs=0.5)


@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_a_soft_limit_that_cannot_hold_leaves_a_solution(wear_gain):
    """The soft limit is set together with hard limits, and the slip starts far below it."""
    limits = ('highest_torque_n_m=280', 'torque_rate_n_m_s=200', 'lowest_slip_rpm=2000')
    kept = run('mpc3', *limits, wear_gain=wear_gain)
    assert rpm_from_rad_s(kept.slip_speed[START]) < 2000.0
    assert np.abs(np.diff(kept.torque_request[START - 1 :])).max() <= 2.0 + 1e-6
    assert solver_states(kept) == {'solved'}
