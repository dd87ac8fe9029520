# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The headless loop is accurate and repeatable, and ends at a value that is not finite."""

import math

import numpy as np
import pytest
from refusals import refused
from samples import sampled
from tight_tolerance import tight_tolerance_run

from ddct_bringup.reproduction.study_run import thesis_run
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_controllers.interface import Command, Controller
from ddct_controllers.registry import controller_names
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))


def run(name):
    return thesis_run(name, 'detailed', 1.0).trajectory


@pytest.mark.parametrize('name', sampled(['ls8', 'pi', 'hinf1'], every=3))
def test_slip_is_within_1e_4_of_its_peak_of_a_tight_tolerance_integration(name):
    slip = run(name).slip_speed
    error = np.abs(slip - tight_tolerance_run(SETTINGS, name)['w_d']).max()
    assert error < 1e-4 * np.abs(slip).max()


@pytest.mark.slow
@pytest.mark.parametrize('name', sampled(controller_names(), every=5))
def test_a_run_repeats_to_the_last_bit(name):
    assert run_headless(SETTINGS, name).sha256() == run(name).sha256()


def test_wear_changes_the_trajectory():
    worn = RunSettings(KnownSettings(SETTINGS.scenario), CaseSettings(wear_gain=0.7))
    assert run_headless(worn, 'ls8').sha256() != run('ls8').sha256()


def test_it_has_every_tick_and_times_every_update():
    timing = RunTiming()
    trajectory = run_headless(SETTINGS, 'pi', timing)
    assert trajectory.steps == SETTINGS.scenario.steps
    assert len(timing.update_times_us) == trajectory.steps + 1
    assert all(time_us > 0.0 for time_us in timing.update_times_us)


def test_feedback_starts_at_the_control_start_of_the_scenario():
    trajectory = run('ls8')
    start = SETTINGS.scenario.control_start_step
    closed_loop = trajectory.closed_loop_torque
    assert not any(closed_loop[:start])
    assert any(closed_loop[start : start + 3])
    np.testing.assert_array_equal(
        trajectory.slip_reference[: start + 1, 0], trajectory.slip_speed[: start + 1]
    )


def test_the_replies_that_were_applied_are_the_efforts_of_the_next_tick():
    trajectory = run('ls8')
    engine, clutch, load, _ = trajectory.joint_effort[1:].T
    np.testing.assert_array_equal(engine, trajectory.engine_torque[:-1])
    np.testing.assert_array_equal(clutch, trajectory.clutch_torque[:-1, -1])
    np.testing.assert_array_equal(load, trajectory.load_torque[:-1])


def test_a_controller_that_commands_nan_ends_the_run():
    class Broken(Controller):
        def reset(self):
            pass

        def update(self, measurement):
            return Command(math.nan)

    with refused(DdctError, "controller 'Broken': its torque at step 60"):
        run_headless(SETTINGS, Broken())


def test_a_plant_beyond_all_numbers_ends_the_run_without_warnings(recwarn):
    heavy = load_scenario('thesis', ['vehicle.gravity_m_s2=1e300'])
    with pytest.raises(DdctError):
        run_headless(RunSettings(KnownSettings(heavy)), 'pi')
    assert [str(each.message) for each in recwarn] == []
