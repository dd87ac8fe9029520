# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plant of a shift by its settings: signals, wear, heat, stall, torque cut, bad settings."""

from dataclasses import replace
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
from refusals import refused
from shifts import SHIFTS, content, run, settings_of, shift_settings

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline import PHASES, DrivelineOutputs
from ddct_plant.plant import Plant, PlantReply
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import CaseSettings, RunSettings


def rows(settings: RunSettings) -> list[dict[str, Any]]:
    """Return the signals of every step of a shift."""
    found: list[dict[str, Any]] = []

    def tick(step: int, plant: Plant, outputs: DrivelineOutputs, reply: PlantReply) -> None:
        found.append(reply.signals)

    run(settings, tick)
    return found


@pytest.mark.parametrize('name', SHIFTS)
def test_a_shift_ends_with_the_on_coming_clutch_locked_and_the_off_going_one_open(name):
    found = rows(shift_settings(name))
    first, last = found[0], found[-1]
    assert PHASES[int(first['clutch_phase'])] == 'open'
    assert PHASES[int(first['off_going_clutch_phase'])] == 'locked'
    assert PHASES[int(last['clutch_phase'])] == 'locked'
    assert PHASES[int(last['off_going_clutch_phase'])] == 'open'
    assert last['off_going_transmitted_torque'] == pytest.approx(0.0, abs=1e-12)
    assert first['joint_effort'].primary_shaft == 0.0
    assert first['off_going_transmitted_torque'] > 0.7 * first['engine_torque']
    assert last['joint_effort'].primary_shaft > 0.8 * last['engine_torque']
    slip = last['joint_speed'].engine - last['off_going_shaft_speed']
    assert last['off_going_slip_speed'] == slip


def test_each_clutch_has_its_own_wear_and_heat():
    new, worn = (rows(shift_settings('upshift', gain)) for gain in (1.0, 0.7))
    step = 35
    carried = new[step]['off_going_clutch_torque'][5]
    assert worn[step]['off_going_clutch_torque'][5] == pytest.approx(0.7 * carried)
    assert worn[step]['clutch_torque'] == new[step]['clutch_torque']
    settings = shift_settings('upshift')
    on_coming_worn = rows(replace(settings, case=CaseSettings(wear_gain=0.7)))
    assert on_coming_worn[step]['clutch_torque'][5] == pytest.approx(
        0.7 * new[step]['clutch_torque'][5]
    )
    assert on_coming_worn[step]['off_going_clutch_torque'] == new[step]['off_going_clutch_torque']
    assert new[-1]['clutch_temperature'] > 20.5
    works = [sum(row[key] for row in new) for key in ('friction_work', 'off_going_friction_work')]
    warmed = [
        new[-1][key] - 20.0 for key in ('clutch_temperature', 'off_going_clutch_temperature')
    ]
    assert works[0] > 100.0 * works[1]
    assert warmed[0] > 100.0 * warmed[1]


def test_two_runs_with_the_same_requests_have_the_same_bits():
    settings = shift_settings('upshift_hot', preselection_s=0.1, disengagement_s=1.5)
    assert rows(settings) == rows(settings)


def test_a_tie_up_stalls_an_engine_with_limits():
    scenario = content((1, 2), 10.0, 20.0, friction={'most_n_m': 2000.0})
    plant = Plant(settings_of(scenario, {'off_going_gear': 1}))
    steps = 0
    while not plant.over:
        observation = plant.observe(plant.tick(steps), 0.0)
        reply = plant.reply(observation, 2000.0, off_going_request=2000.0)
        plant.advance(reply)
        steps += 1
        assert steps < 100
    assert plant.driveline.engine_speed <= 52.36


def test_a_torque_cut_is_taken_off_the_demand():
    plant = Plant(shift_settings('upshift'))
    observation = plant.observe(plant.tick(0), torque_cut=30.0)
    assert (observation.requested, observation.delivered, observation.engine_torque) == (70.0,) * 3
    reply = plant.reply(observation, 0.0)
    assert (reply.engine_torque, reply.signals['torque_demand']) == (70.0, 100.0)


def test_a_controller_that_commands_the_engine_gets_what_it_requests():
    plant = Plant(shift_settings('upshift'), two_input=True)
    observation = plant.observe(plant.tick(0), torque_cut=30.0)
    assert (observation.delivered, observation.engine_torque) == (None, 70.0)
    reply = plant.reply(observation, 0.0, 82.0)
    assert reply.engine_torque == pytest.approx(82.0, rel=1e-15)


def test_an_engine_with_a_rate_gets_one_request_a_step():
    slow = content((1, 2), 20.0, 100.0, engine_authority={'slew_n_m_s': 500.0})
    plant = Plant(settings_of(slow, {'off_going_gear': 1}), two_input=True)
    observation = plant.observe(plant.tick(0), torque_cut=0.0)
    reply = plant.reply(observation, 0.0, 60.0)
    assert reply.engine_torque == 95.0


def test_a_controller_reads_the_sensors_where_the_scenario_has_some():
    sensors = {'engine_speed': {'noise_rad_s': 0.5}}
    plant = Plant(
        settings_of(content((1, 2), 20.0, 100.0, sensors=sensors), {'off_going_gear': 1})
    )
    outputs = plant.driveline.outputs()
    observation = plant.observe(plant.tick(0), torque_cut=0.0)
    assert observation.tick.true == outputs
    assert observation.tick.measured.engine_speed != outputs.engine_speed
    reply = plant.reply(observation, 0.0)
    assert 'sensed_slip_speed' in reply.signals


def test_the_off_going_clutch_stays_locked_until_the_shift_starts():
    for row in rows(shift_settings('upshift_full', preselection_s=0.2))[:30]:
        assert PHASES[int(row['off_going_clutch_phase'])] == 'locked'
        assert row['friction_work'] == row['off_going_friction_work'] == 0.0


def test_the_example_of_the_page_shifts():
    page = Path(__file__).resolve().parents[3] / 'docs' / 'develop' / 'gear_shift.md'
    text = page.read_text(encoding='utf-8').split('\n| question')[0]
    lines = text.partition('In Python:\n')[2].splitlines()
    names: dict[str, Any] = {}
    exec(dedent('\n'.join(line for line in lines if not line or line[0] == ' ')), names)
    outputs = names['plant'].driveline.outputs()
    assert PHASES[int(outputs.clutch_phase)] == 'locked'
    assert PHASES[int(outputs.off_going.clutch_phase)] == 'open'


@pytest.mark.parametrize(
    ('key', 'scenario', 'shift'),
    [
        ('shift.off_going_gear', {}, {'off_going_gear': 2}),
        ('shift.off_going_gear', {}, {'off_going_gear': 9}),
        ('shift.off_going_gear', {'gear': 3}, {}),
        ('shift.preselection_s', {}, {'preselection_s': 0.5}),
        ('shift.preselection_s', {}, {'preselection_s': 0.123}),
        ('shift.disengagement_s', {}, {'disengagement_s': 0.2}),
        ('shift.disengagement_s', {}, {'preselection_s': 0.2, 'disengagement_s': 0.1}),
        ('initial.engine_speed_rad_s', {'initial': {'engine_speed_rad_s': 250.0}}, {}),
        ('initial.shaft_speed_rad_s', {'initial': None}, {}),
        ('initial.clutch_phase', {'initial': {'clutch_phase': 'slipping'}}, {}),
    ],
)
def test_settings_that_do_not_fit_are_refused(key, scenario, shift):
    good = content((1, 2), 20.0, 100.0)
    bad = {**good, **scenario}
    given = scenario.get('initial', {})
    standing = {'engine_speed_rad_s': 0.0, 'shaft_speed_rad_s': 0.0}
    bad['initial'] = standing if given is None else {**good['initial'], **given}
    with refused(ParameterError, key):
        initial_state(settings_of(bad, {'off_going_gear': 1, **shift}))


def test_the_linear_clutch_and_impossible_wear_are_refused():
    linear = content((1, 2), 20.0, 100.0, closing=None, clutch='linear')
    with refused(ParameterError, 'shift'):
        settings_of(linear, {'off_going_gear': 1}, 1.0)
    with refused(ParameterError, 'off_going_wear_gain'):
        shift_settings('upshift', 0.0)
