# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller gets the known settings alone, and the plant the true ones."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest
from received import (
    UNKNOWN,
    UNKNOWN_IN_A_SHIFT,
    found_in,
    keeper_file,
    settings_with,
    true_values,
)
from refusals import refused

from ddct_bringup.batch.simulate import simulate_batch
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.run_set import PlannedRow
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_python import chosen_from
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.linear import PiController
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.file import ScenarioFile, load_scenario
from ddct_plant.scenario.initial_state import initial_request, initial_state
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings
from ddct_plant.shift.roles import OFF_GOING

NOISE = 'sensors.engine_speed.noise_rad_s'
NOISY = {'engine_speed': {'noise_rad_s': 0.1}}


def noise_of(settings: KnownSettings) -> Any:
    """Return the noise of the engine speed's sensor in rad/s."""
    assert settings.scenario.sensors is not None
    return asdict(settings.scenario.sensors)['engine_speed']['noise_rad_s']


def test_a_run_without_a_case_has_the_known_scenario_and_a_case_leaves_it() -> None:
    settings = settings_with({})
    assert settings.scenario is settings.known.scenario
    assert settings.case == CaseSettings()
    varied = settings_with({'wear_gain': 0.8, 'vehicle.mass_kg': 1789.25})
    assert varied.known == settings.known
    assert varied.scenario.vehicle.mass_kg == 1789.25
    same = settings_with({'vehicle.mass_kg': settings.scenario.vehicle.mass_kg})
    assert same == settings


@pytest.mark.parametrize(
    ('scenario', 'varied'), [('launch', UNKNOWN), ('upshift', UNKNOWN_IN_A_SHIFT)]
)
def test_a_controller_and_a_handover_find_no_true_value_in_a_headless_run(
    tmp_path: Path, scenario: str, varied: dict[str, Any]
) -> None:
    settings = settings_with(varied, scenario)
    values = true_values(settings)
    assert len(values) == len(varied) + 1  # the inertia follows from the mass
    assert sorted(found_in(settings, values)) == sorted(values)
    file, kept = keeper_file(tmp_path)
    run_headless(settings, file)
    (keeper,) = kept
    assert len(keeper.measurements) == settings.scenario.steps + 1
    assert not found_in(keeper, values)
    if settings.shift:
        assert not found_in(make_handover(settings.known), values)


def test_load_and_open_loop_of_a_measurement_are_those_of_the_known_car(tmp_path: Path) -> None:
    settings = settings_with({'vehicle.mass_kg': 1900.0}, 'thesis')
    file, kept = keeper_file(tmp_path)
    run = run_headless(settings, file)
    known = settings.known.scenario
    static = StaticTorque(known.driveline, known.equilibrium)
    for now in kept[0].measurements:
        load = RoadLoad(known.load, known.vehicle).torque(now.vehicle_speed)
        assert now.load_torque == load < run.load_torque[now.step]
        speeds = now.engine_speed, now.shaft_speed
        assert now.open_loop_torque == static.torque(now.engine_torque, load, *speeds)


@pytest.mark.parametrize('scenario', ['launch', 'upshift'])
def test_runs_that_differ_in_an_unknown_key_give_equal_contexts(
    tmp_path: Path, scenario: str
) -> None:
    file, kept = keeper_file(tmp_path)
    runs = [
        run_headless(settings_with({key: value}, scenario), file)
        for key, value in [('vehicle.mass_kg', 1500.0), *UNKNOWN.items()]
    ]
    contexts = [each.context for each in kept]
    assert len(contexts) == len(UNKNOWN) + 1
    assert all(context == contexts[0] for context in contexts)
    assert len({run.sha256() for run in runs}) == len(UNKNOWN)  # no sensor, so no seed


def test_the_first_request_is_that_of_the_known_car_and_the_state_that_of_the_true_one() -> None:
    varied = {'load.slope_rad': 0.08, 'wear_gain': 0.8}
    hill, plain = settings_with(varied, 'tip_in'), settings_with({}, 'tip_in')
    assert (
        initial_request(hill.known)
        == initial_request(plain.known)
        == initial_state(hill).sides[0].torque_request
    )
    assert initial_state(hill).load_torque > initial_state(plain).load_torque
    shift, usual = settings_with(varied, 'upshift'), settings_with({}, 'upshift')
    assert initial_request(shift.known, OFF_GOING) == initial_request(usual.known, OFF_GOING)


@pytest.mark.parametrize('architecture', ['detailed', 'feedforward', 'feedforward_tanh', 'base'])
def test_a_batch_and_a_run_step_by_step_know_the_same(architecture: str) -> None:
    varied = {**UNKNOWN, 'load.wind_speed_m_s': 7.0, 'vehicle.wheel_radius_m': 0.3}
    cases = [settings_with(each, 'thesis', architecture=architecture) for each in ({}, varied)]
    controller = make_controller('pi', cases[0].known)
    stack = simulate_batch(cases, [controller] * 2).trajectory
    for place, settings in enumerate(cases):
        alone = run_headless(settings, 'pi')
        for name in ('slip_speed', 'torque_request', 'load_torque', 'slip_reference'):
            ours, theirs = getattr(stack, name)[place], getattr(alone, name)
            assert ours.ravel() == pytest.approx(theirs.ravel(), rel=1e-9, abs=1e-9), name


def test_a_controller_of_a_batch_finds_no_true_value() -> None:
    made = []

    class Kept(PiController):
        def __init__(self, context: Any) -> None:
            self.context = context
            super().__init__(0.1, 0.2)
            made.append(self)

    settings = settings_with(UNKNOWN, 'thesis')
    controller = make_controller(chosen_from(Kept), settings.known)
    stack = simulate_batch([settings], [controller])
    assert stack.trajectory.slip_speed.shape[0] == 1
    assert made
    assert not found_in(made, true_values(settings))


def test_a_controller_of_a_campaign_finds_no_true_value_of_its_row(tmp_path: Path) -> None:
    file, kept = keeper_file(tmp_path)
    content = {
        'controllers': [file],
        'seed': 4,
        'grid': {
            'scenario': ['launch', 'thesis_sticking'],
            'duration_s': [0.9],
            'sensors': [NOISY],
            'wear_gain': [0.8125],
        },
        'random': {
            'samples': 2,
            'vary': {
                'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1600, 'high': 1900},
                'actuator.delay_s': {'distribution': 'choice', 'values': [0.013, 0.017]},
            },
        },
    }
    campaign = Campaign(spec_of(content, tmp_path))
    rows = list(campaign.planned(0, campaign.runs))
    Scorer(packaged_limits(), at_once=False).scored(rows)
    assert len(kept) == len(rows) == 4
    for row, keeper in zip(rows, kept, strict=True):
        assert isinstance(row, PlannedRow)
        values = true_values(row.settings)
        assert len(values) == 5
        assert keeper.measurements
        assert not found_in(keeper, values)
        known = keeper.context.settings
        assert known.scenario.name == row.varied['scenario']
        assert noise_of(known) == 0.1
        assert known.clutch == 'stick_slip'
        assert known.scenario.duration_s == 0.9


def test_options_handover_and_reference_of_a_row_are_known_and_drawn_sensors_are_not() -> None:
    varied = {
        'controllers.pi.proportional_gain': 0.3,
        'handover': 'slip',
        'closing.margin': 1.5,
        NOISE: 0.2,
        'control_start_s': 0.4,
    }
    base = RunBase(ScenarioFile.read('upshift'), {}, {}, ['pi'])
    for drawn, noise in (((), 0.2), ((NOISE,), 0.0)):
        known = base.at(varied, drawn).known
        assert known.handover == 'slip'
        assert known.scenario.controllers['pi']['proportional_gain'] == 0.3
        assert known.scenario.closing is not None
        assert known.scenario.closing.margin == 1.5
        assert known.scenario.control_start_s == 0.4
        assert noise_of(known) == noise


def test_known_settings_of_another_kind_of_run_are_refused() -> None:
    upshift, launch = load_scenario('upshift'), load_scenario('launch')
    with refused(ParameterError, key='shift'):
        RunSettings(KnownSettings(launch), CaseSettings(scenario=upshift))
    noisy = load_scenario('launch', {'sensors': NOISY})
    with refused(ParameterError, key='sensors'):
        RunSettings(KnownSettings(launch), CaseSettings(scenario=noisy))
    linear, sticking = load_scenario('thesis'), load_scenario('thesis_sticking')
    with refused(ParameterError, key='clutch'):
        RunSettings(KnownSettings(sticking), CaseSettings(scenario=linear))
