# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Published table of the least peak jerk of a launch, computed with its own definitions.

The jerk is the difference of A_x over 10 ms, unfiltered, from control start on; torque and load
are those of the run of `ls8`. The table has two or three digits.
"""

import numpy as np
import pytest
from samples import sampled

from ddct_bringup.floor.bound import bound_of
from ddct_bringup.floor.case import Case
from ddct_bringup.floor.dynamics.capacity import capacity_range
from ddct_bringup.floor.dynamics.engine_laws import EngineLaw
from ddct_bringup.floor.dynamics.laws import Law
from ddct_bringup.floor.dynamics.start import start_of
from ddct_bringup.floor.dynamics.tube import rigid_tube
from ddct_bringup.floor.lock import Lock
from ddct_bringup.floor.objectives import Peak, Signals
from ddct_bringup.metrics.lockup import Lockup
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

LEAST = {
    0.40: 18.4,
    0.45: 15.7,
    0.50: 13.7,
    0.60: 10.7,
    0.70: 8.7,
    0.80: 7.4,
    0.90: 6.3,
    1.00: 5.6,
    1.10: 5.39,
}
"""Least peak jerk in m/s^3 by lock time in s after control start."""
RATIOS = {
    'hinf_sampled': (1.13, 8.9, 1.6),
    'hinf1': (1.18, 10.5, 2.0),
    'ls8': (1.13, 11.3, 2.1),
    'mpc_offset_free': (1.24, 24.3, 4.5),
    'pedal_mpc': (1.30, 25.1, 4.7),
    'hinf2': (1.05, 96.3, 17.9),
}
"""Last lock in s, peak jerk in m/s^3 and its ratio to the least at that time, by controller."""
WITHIN = 0.02
RAW_JERK = Peak(lambda signals: 100.0 * np.diff(signals.acceleration[..., signals.start :]))


class GivenTorques(Case):
    """Runs in which C_m and C_load are those of one run, whatever the speeds."""

    given = (np.zeros(0), np.zeros(0))

    @property
    def engine(self):
        """C_m of the run."""
        none = np.zeros(len(self.given[0]))
        return EngineLaw(self.given[0], none, none, none)

    @property
    def load(self):
        """Torque at the wheel of the run."""
        none = np.zeros(len(self.given[1]))
        return Law(self.given[1], none, none, none)


@pytest.fixture(scope='module')
def settings():
    return RunSettings(KnownSettings(load_scenario('launch')))


@pytest.fixture(scope='module')
def least_at(settings):
    """Return a function from a lock time in s to the least peak jerk in m/s^3."""
    run = run_headless(settings, 'ls8')
    start = start_of(settings, run)
    given = (
        run.engine_torque[start.step :],
        (run.load_torque + run.holding_torque)[start.step :],
    )

    def least(lock_time_s):
        case = GivenTorques(
            settings,
            start,
            Lock(lock_time_s),
            rigid_tube(settings, start, lock_time_s),
            False,
            capacity_range(settings, start.temperature_c),
            packaged_limits().rules,
            2000.0,
        )
        object.__setattr__(case, 'given', given)
        signals = Signals.of_motion(case.motion, settings.scenario)
        return bound_of(case, RAW_JERK, signals).least

    return least


@pytest.mark.parametrize('lock_time_s', sampled(LEAST, every=2))
def test_the_least_peak_jerk_is_that_of_the_published_table(least_at, lock_time_s):
    assert least_at(lock_time_s) == pytest.approx(LEAST[lock_time_s], rel=WITHIN)


@pytest.mark.parametrize('controller', sampled(RATIOS, every=2))
def test_controllers_are_as_far_above_the_least_as_published(settings, least_at, controller):
    lock_s, peak, ratio = RATIOS[controller]
    run = run_headless(settings, controller)
    start = settings.scenario.control_start_step
    last = float(Lockup(run, start).final_lock_s)
    assert last == pytest.approx(lock_s, rel=WITHIN)
    jerk = 100.0 * np.abs(np.diff(run.vehicle_accel[start:])).max()
    assert jerk == pytest.approx(peak, rel=WITHIN)
    # The published ratios have two digits.
    assert jerk / least_at(last) == pytest.approx(ratio, rel=WITHIN, abs=0.05)
