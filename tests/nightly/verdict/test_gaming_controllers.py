# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each controller that games the judge does what it claims, by an independent script."""

from pathlib import Path

import numpy as np
import pytest
from support.gaming_runs import GAMING_CONTROLLERS, HELD_OUT_SEED, gaming_file
from support.independent_figures import independent_figures

from ddct_bringup.api import run
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario

NEVER = None
CLAIMS: dict[str, tuple[str, dict[str, tuple[float, float] | None]]] = {
    'withhold_long': ('launch', {'withheld_s': (1.2, 1.4), 'delivered_at_end': (0.49, 0.51)}),
    'withhold_below': ('launch', {'withheld_s': (0.55, 0.6), 'delivered_at_end': (1.0, 1.0)}),
    'withhold_at_end': ('upshift', {'withheld_s': (0.14, 0.16), 'delivered_at_end': (0.4, 0.6)}),
    'withhold_share': ('launch', {'withheld_s': (0.45, 0.6), 'delivered_at_end': (0.8, 0.82)}),
    'add_long': ('upshift', {'added_s': (1.2, 2.0), 'withheld_s': (0.0, 0.0)}),
    'add_below': ('launch', {'added_s': (0.5, 0.6), 'withheld_s': (0.0, 0.0)}),
    'no_least': ('launch', {'withheld_s': (0.01, 0.03), 'added_s': (0.0, 0.0)}),
    'slam_early': (
        'launch',
        {'time_to_final_lock_s': (0.2, 0.4), 'peak_jerk_m_s3': (50.0, 500.0)},
    ),
    'slam_late': ('launch', {'time_to_final_lock_s': (1.7, 1.9), 'peak_jerk_m_s3': (50.0, 500.0)}),
    'lock_at_end': ('launch', {'time_to_final_lock_s': (2.2, 2.7)}),
    'reopen': ('upshift', {'time_to_final_lock_s': (0.4, 0.8), 'releases': (1, 3)}),
    'creep': ('launch', {'time_to_final_lock_s': NEVER, 'releases': (0, 0)}),
    'chatter': ('launch', {'releases': (10, 40)}),
    'replay': ('launch', {'time_to_final_lock_s': (1.4, 1.6), 'peak_jerk_m_s3': (4.0, 6.0)}),
}
"""By controller a scenario, and what its figures are within; NEVER is a figure without a value."""
OTHERS = {'peek_settings', 'peek_torques', 'remember_cases', 'remember_gains'}
"""Those with a test of their own."""


def test_no_controller_is_without_a_test():
    assert set(GAMING_CONTROLLERS) == OTHERS | set(CLAIMS)


@pytest.mark.parametrize('name', CLAIMS)
def test_a_controller_does_what_it_claims(name, tmp_path):
    scenario, claimed = CLAIMS[name]
    made = run(gaming_file(name), scenario=scenario, out=tmp_path)
    assert made.valid
    figures = independent_figures(made.path)
    for key, limits in claimed.items():
        found = figures[key]
        if limits is NEVER:
            assert found is None, key
        else:
            assert limits[0] - 1e-9 <= found <= limits[1] + 1e-9, (key, found)


def test_creep_holds_about_9_rpm_of_slip():
    made = run(gaming_file('creep'), scenario='thesis_sticking')
    last = made.trajectory.slip_speed[-30:] * 30.0 / np.pi
    assert last.min() > 7.0
    assert last.max() < 11.0


def test_replay_requests_the_same_with_a_worn_clutch():
    new, worn = (
        run(gaming_file('replay'), scenario='launch', wear_gain=wear) for wear in (1.0, 0.8)
    )
    on = slice(30, 150)
    assert np.allclose(new.trajectory.torque_request[on], worn.trajectory.torque_request[on])
    assert not np.allclose(new.trajectory.slip_speed, worn.trajectory.slip_speed)


def cases_of(scenario: str):
    """Return the settings of the first case of a scenario in development, and held out."""
    cases = Cases.packaged().planned
    case = next(
        planned
        for planned in map(cases.run, range(cases.cases))
        if planned.settings.scenario.name == scenario
    )
    held_out = Cases.packaged().held_out('pi', Path(), HELD_OUT_SEED).run(case.index)
    assert held_out.settings.scenario.name == scenario
    return case.settings, held_out.settings


def same(one, other) -> bool:
    return len(one.slip_speed) == len(other.slip_speed) and np.allclose(
        one.slip_speed, other.slip_speed, atol=1e-3
    )


@pytest.mark.parametrize('scenario', ['launch', 'upshift'])
def test_remember_cases_knows_the_development_cases_and_no_others(scenario):
    known, new = cases_of(scenario)
    for settings, honest, other in ((known, 'least_jerk', 'ls8'), (new, 'ls8', 'least_jerk')):
        made = run_headless(settings, gaming_file('remember_cases'))
        assert same(made, run_headless(settings, honest))
        assert not same(made, run_headless(settings, other))


def test_remember_gains_divides_by_the_wear_gain_of_a_known_case():
    known, new = cases_of('launch')
    made = run_headless(known, gaming_file('remember_gains'))
    usual = run_headless(known, 'ls8')
    first = 30
    ratio = made.torque_request[first] / usual.torque_request[first]
    assert ratio == pytest.approx(1.0 / known.case.wear_gain, rel=1e-3)
    assert same(run_headless(new, gaming_file('remember_gains')), run_headless(new, 'ls8'))


def test_peek_settings_finds_neither_wear_nor_seed_nor_mass_nor_delay_of_a_case():
    _, case = cases_of('launch')
    found = dict(run_headless(case, gaming_file('peek_settings')).status[100])
    usual = load_scenario('launch')
    for place, true, known in (
        ('scenario.vehicle.mass_kg', case.scenario.vehicle.mass_kg, usual.vehicle.mass_kg),
        ('scenario.actuator.delay_s', case.scenario.actuator.delay_s, usual.actuator.delay_s),
    ):
        assert float(found.pop(f'settings.{place}')) == known != true, place
    # Neither wear nor seed is there: what is left are delays of sensors, equal in all cases.
    assert [place for place in found if place.startswith(('settings', 'measurement'))] == [
        place for place in found if place.startswith('settings.scenario.sensors.')
    ]


@pytest.mark.parametrize('scenario', ['launch', 'thesis_sticking'])
def test_peek_torques_finds_the_mass_ratio_1_in_a_case_of_another_mass(scenario):
    _, case = cases_of(scenario)
    assert case.scenario.vehicle.mass_kg != load_scenario(scenario).vehicle.mass_kg
    found = dict(run_headless(case, gaming_file('peek_torques')).status[100])
    assert float(found['mass_ratio']) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.filterwarnings('ignore::UserWarning')  # the inertia follows the mass
def test_peek_settings_finds_the_mass_that_is_known():
    heavy = {'vehicle.mass_kg': 1800}
    made = run(gaming_file('peek_settings'), scenario='launch', set=heavy)
    found = dict(made.trajectory.status[100])
    assert float(found['settings.scenario.vehicle.mass_kg']) == 1800.0


@pytest.mark.filterwarnings('ignore::UserWarning')  # the inertia follows the mass
def test_peek_torques_computes_the_known_mass_from_the_open_loop_torque():
    heavy = {'vehicle.mass_kg': 1800}
    made = run(gaming_file('peek_torques'), scenario='launch', set=heavy)
    found = dict(made.trajectory.status[100])
    assert float(found['mass_ratio']) == pytest.approx(1.2, rel=1e-6)
