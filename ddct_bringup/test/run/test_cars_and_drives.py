# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Options of programs, of Python and of campaigns choose a car and a drive."""

import argparse
from pathlib import Path
from typing import Any

import pytest
from refusals import refused

from ddct_bringup import api
from ddct_bringup.api.arguments import run_settings
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.programs.options.of_runs import add_run_options, settings_given
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.slow


def settings(*options: str) -> RunSettings:
    """Return the settings of a run that options of a program give."""
    parser = argparse.ArgumentParser()
    add_run_options(parser)
    given = parser.parse_args(options)
    return run_settings([], **settings_given(given))


@pytest.mark.parametrize(
    ('options', 'chosen'),
    [
        ([], {}),
        (['--car', 'city7', '--drive', 'launch'], {'car': 'city7', 'drive': 'launch'}),
        (
            ['--scenario', 'launch_hot', '--car', 'city7'],
            {'scenario': 'launch_hot', 'car': 'city7'},
        ),
        (['--drive', 'launch'], {'drive': 'launch'}),
        (['--car', 'city7', '--drive', 'upshift'], {'car': 'city7', 'drive': 'upshift'}),
        (['--car', 'c635_no_limits'], {'car': 'c635_no_limits'}),
    ],
)
def test_options_choose_what_load_scenario_does(options: list[str], chosen: Any) -> None:
    assert settings(*options).scenario == load_scenario(**chosen)


def test_python_takes_names_and_paths(tmp_path: Path) -> None:
    car = tmp_path / 'heavy.yaml'
    car.write_text('base: c635\nfriction: {most_n_m: 400.0}\n', encoding='utf-8')
    short = {'duration_s': 0.5, 'score_window_s': [0.3, 0.5]}
    run = api.run('pi', car=car, drive='launch', set=short)
    assert run.settings is not None
    assert run.settings.scenario.name == 'launch_heavy'
    assert run.settings.scenario.friction.most_n_m == 400.0


SPEC: dict[str, Any] = {
    'controllers': ['pi'],
    'grid': {'car': ['c635', 'mine.yaml'], 'drive': ['launch', 'launch_gentle']},
}


def campaign(folder: Path, **changes: Any) -> Campaign:
    (folder / 'mine.yaml').write_text('base: c635\nfriction: {most_n_m: 400.0}\n')
    return Campaign(spec_of({**SPEC, **changes}, folder))


def test_a_campaign_varies_cars_and_drives_without_a_scenario(tmp_path: Path) -> None:
    made = campaign(tmp_path)
    scenarios = [made.run(index).settings.scenario for index in range(made.runs)]
    assert [each.name for each in scenarios] == [
        *('launch_c635', 'launch_gentle_c635', 'launch_mine', 'launch_gentle_mine')
    ]
    assert [each.friction.most_n_m for each in scenarios] == [350.0, 350.0, 400.0, 400.0]
    assert all(made.run(index).settings.known.scenario == scenarios[index] for index in range(4))


def test_a_car_of_all_runs_drives_each_scenario_of_the_grid(tmp_path: Path) -> None:
    made = campaign(tmp_path, car='mine.yaml', grid={'scenario': ['launch', 'launch_hot']})
    names = [made.run(index).settings.scenario.name for index in range(2)]
    assert names == ['launch_mine', 'launch_hot_mine']
    assert made.run(1).settings.scenario.friction.kiss_drift_n_m_k == 0.1


def test_a_changed_car_changes_the_digest_of_a_campaign(tmp_path: Path) -> None:
    made = campaign(tmp_path)
    before = made.digest()
    (tmp_path / 'mine.yaml').write_text('base: c635\n', encoding='utf-8')
    assert made.digest() != before


@pytest.mark.parametrize('where', [{'car': 'city8'}, {'grid': {'car': ['city8']}}])
def test_an_unknown_car_of_a_campaign_is_refused_with_a_similar_one(
    tmp_path: Path, where: dict[str, Any]
) -> None:
    with refused(ParameterError, key='city8') as caught:
        campaign(tmp_path, **{'grid': {'wear_gain': [1.0]}, **where})
    assert 'did you mean city7?' in str(caught.value)


def test_a_sweep_names_the_option_for_a_car() -> None:
    with refused(ParameterError, key='--over') as caught:
        api.sweep('pi', over={'car': ['c635', 'city7']})
    assert '--car' in str(caught.value)


def test_python_lists_the_packaged_cars_and_drives() -> None:
    assert {'c635', 'city7'} < {*api.car_names()}
    assert {*api.drive_names()} < {*api.scenario_names()}
