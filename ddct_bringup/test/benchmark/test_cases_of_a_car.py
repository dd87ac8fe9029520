# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The cases of a benchmark stay in a release, and with another car are drawn around its values."""

import hashlib
from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.release import columns_kept
from ddct_bringup.campaign.spec import spec_of
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import json_text
from ddct_plant.scenario.content import scenario_content

OF_RELEASE = 'fa590dae490be7b1cddf1389a044fc440cb61a96e940647537db1e705b71338c'
"""Digest of the cases of the release, without a car."""
DRAWN = '738f2f3eab75cf5eaaf772711973c02ee78e3f641d1ad9ddf34fb4ac4f1cbbfc'
"""SHA-256 of what is drawn for these cases."""
SENSORS = '{engine_speed: {gain: 0.9}}'
UNABLE = {'thesis_sticking', 'tip_in'}
"""Scenarios that ask more than the engine of `city7` gives."""


def varied(given: Cases) -> dict[str, Any]:
    """Return the drawn keys with their ends."""
    vary = given.whole.vary
    return {key: vary[key].ends for key in vary}


def test_the_cases_of_the_release_stay_as_they_are() -> None:
    given = Cases.packaged()
    drawn = hashlib.sha256()
    for campaign in (given.planned, given.held_out('pi', Path(), 77)):
        table = campaign.varied(range(campaign.cases))
        seeds = [run.seed for run in campaign.planned(0, 3)]
        drawn.update(json_text([[dict(row) for row in table], seeds]).encode())
    assert (given.digest, drawn.hexdigest()) == (OF_RELEASE, DRAWN)
    assert given.left_out == {}


def test_another_car_is_drawn_around_its_own_values_in_the_scenarios_that_it_can_drive() -> None:
    plain, given = Cases.packaged(), Cases.packaged(car='city7')
    assert varied(given) == {
        'wear_gain': (0.7, 1.3),
        'actuator.delay_s': (0.005, 0.02),
        'vehicle.mass_kg': pytest.approx((0.8 * 1150.0, 1.3 * 1150.0)),
    }
    assert given.left_out.keys() == UNABLE
    assert 'the engine gives at most 175 N m' in given.left_out['tip_in']
    scenarios = [name for name in plain.whole.values_of('scenario') if name not in UNABLE]
    assert list(given.whole.values_of('scenario')) == scenarios
    assert given.whole.values_of('sensors') == plain.whole.values_of('sensors')
    run = given.planned.run(3)
    assert run.settings.known.scenario.vehicle.mass_kg == 1150.0
    assert run.settings.scenario.vehicle.mass_kg == run.varied['vehicle.mass_kg']
    assert varied(Cases.packaged(car='c635')) == varied(plain)


def test_sensors_of_a_car_stay_and_a_delay_of_zero_is_not_drawn(tmp_path: Path) -> None:
    car = tmp_path / 'mine.yaml'
    for delay, ends in ((0.0, None), (0.004, (0.002, 0.008))):
        text = f'base: city7\nactuator: {{delay_s: {delay}}}\nsensors: {SENSORS}\n'
        car.write_text(text, encoding='utf-8')
        given = Cases.packaged(car=str(car))
        assert varied(given).get('actuator.delay_s') == ends
        known = given.planned.run(0).settings.known.scenario
        assert scenario_content(known)['sensors']['engine_speed']['gain'] == 0.9


def test_rows_of_a_single_scenario_name_it() -> None:
    content = {**Cases.packaged().content, 'grid': {'scenario': ['launch']}}
    assert 'scenario' in columns_kept(spec_of(content, Path()))


def test_a_car_whose_clutch_cannot_lock_is_refused() -> None:
    with pytest.raises(DdctError, match='has the clutch linear, which cannot lock'):
        Cases.packaged(car='c635_thesis')
