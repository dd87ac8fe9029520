# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each index is one run: its case, its controller, dependent values, its seed."""

from pathlib import Path
from typing import Any

import pytest
from refusals import refused

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.run_set import (
    MOST_CHECKED,
    ImpossibleRow,
    PlannedRow,
    checked_cases,
)
from ddct_bringup.campaign.spec import spec_of
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import load_scenario

SPEC: dict[str, Any] = {
    'controllers': ['pi', 'ls8'],
    'seed': 3,
    'grid': {'wear_gain': [0.7, 1.0], 'clutch': ['linear', 'stick_slip']},
    'random': {
        'samples': 3,
        'vary': {'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1000, 'high': 2000}},
    },
}
PROFILE = {'csv': 'pedal.csv', 'time': 't', 'value': 'c', 'unit': 'N m'}


def campaign(folder: Path = Path(), **changes: Any) -> Campaign:
    return Campaign(spec_of({**SPEC, **changes}, folder))


def test_the_indices_go_through_controllers_then_the_grid_then_samples() -> None:
    made = campaign()
    assert (made.runs, made.cases) == (24, 12)
    runs = [made.run(index) for index in range(24)]
    assert [run.controller.name for run in runs] == ['pi'] * 12 + ['ls8'] * 12
    grid = [(run.varied['wear_gain'], run.varied['clutch']) for run in runs[:12:3]]
    assert grid == [(0.7, 'linear'), (0.7, 'stick_slip'), (1.0, 'linear'), (1.0, 'stick_slip')]
    assert [
        (run.settings.case.wear_gain, run.settings.known.clutch) for run in runs[:12:3]
    ] == grid


def test_all_controllers_have_the_same_cases_with_the_same_noise() -> None:
    made = campaign()
    for case in range(made.cases):
        first, second = made.run(case), made.run(case + made.cases)
        assert first.varied == second.varied
        assert first.settings == second.settings
    assert len({made.run(case).settings.case.seed for case in range(made.cases)}) == made.cases
    assert len({made.run(case).varied['vehicle.mass_kg'] for case in range(made.cases)}) == 12


@pytest.mark.parametrize('cases', [range(8), range(3, 6)])
def test_the_first_samples_of_a_campaign_are_those_of_the_whole_one(cases: range) -> None:
    part = campaign(random={'samples': 2, 'of': 3, 'vary': SPEC['random']['vary']})
    whole = campaign()
    assert part.cases == 8
    for run in part.planned(cases.start, cases.stop):
        point, sample = divmod(run.index, 2)
        same = whole.run(3 * point + sample)
        assert (run.varied, run.seed) == (same.varied, same.seed)


def test_another_key_does_not_change_what_a_key_draws() -> None:
    vary = SPEC['random']['vary']
    more = {'pedal_position': {'distribution': 'uniform', 'low': 0, 'high': 1}, **vary}
    other = campaign(random={'samples': 3, 'vary': more})
    for case in range(12):
        drawn = other.varied(range(case, case + 1))[0]['vehicle.mass_kg']
        assert drawn == campaign().varied(range(12))[case]['vehicle.mass_kg']


def test_dependent_values_change_with_varied_ones() -> None:
    made = campaign(grid={'gear': [1, 3]})
    for index in (0, 4):
        run = made.run(index)
        mass = run.varied['vehicle.mass_kg']
        changes = {'gear': run.varied['gear'], 'vehicle.mass_kg': mass}
        assert run.settings.scenario == load_scenario('thesis', changes)
        assert run.settings.scenario.driveline.vehicle_inertia != pytest.approx(mass)


def test_a_whole_profile_varies_by_its_points_or_by_files_beside_the_specification(
    tmp_path: Path,
) -> None:
    (tmp_path / 'pedal.csv').write_text('t,c\n0,10\n1,40\n', encoding='utf-8')
    points = {'time_s': [0.0, 1.0], 'torque_n_m': [5.0, 6.0]}
    made = campaign(tmp_path, grid={'engine': [points, PROFILE]}, random={**SPEC['random']})
    assert made.run(0).settings.scenario.engine.torque_n_m == (5.0, 6.0)
    assert made.run(3).settings.scenario.engine.torque_n_m == (10.0, 40.0)


def test_a_file_of_a_profile_varies_where_the_scenario_takes_one(tmp_path: Path) -> None:
    scenario = tmp_path / 'own.yaml'
    scenario.write_text(
        'car: c635_thesis\ndrive: {duration_s: 0.2, control_start_s: 0.1, '
        'score_window_s: [0.1, 0.2], engine: {csv: a.csv, time: t, value: c, unit: N m}}\n',
        encoding='utf-8',
    )
    for name, torque in (('a.csv', 10), ('b.csv', 20)):
        (tmp_path / name).write_text(f't,c\n0,{torque}\n', encoding='utf-8')
    made = campaign(tmp_path, scenario='own.yaml', grid={'engine.csv': ['a.csv', 'b.csv']})
    torques = [made.run(index).settings.scenario.engine.torque_n_m for index in (0, 3)]
    assert torques == [(10.0,), (20.0,)]
    before = made.digest()
    (tmp_path / 'b.csv').write_text('t,c\n0,21\n', encoding='utf-8')
    assert made.digest() != before
    (tmp_path / 'b.csv').unlink()
    with refused(DdctError, place='b.csv'):
        made.digest()


def test_a_sample_that_the_scenario_refuses_is_named_with_its_index_and_values() -> None:
    made = campaign(grid={'duration_s': [1.0, 3.0], 'control_start_s': [0.6, 2.4]})
    with refused(ParameterError, 'score_window_s') as caught:
        made.require_sound()
    assert caught.value.place.startswith('run 3 (duration_s 1.0, control_start_s 2.4, vehicle.')


def test_the_check_before_the_first_run_builds_each_case_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = campaign()
    built: list[int] = []
    run = made.run

    def counted(index: int) -> PlannedRow:
        built.append(index)
        return run(index)

    monkeypatch.setattr(made, 'run', counted)
    made.require_sound()
    assert built == [*range(made.cases)]


def test_the_check_before_the_first_run_does_not_grow_with_the_number_of_runs() -> None:
    assert checked_cases(3) == [0, 1, 2]
    assert len(checked_cases(MOST_CHECKED)) == MOST_CHECKED
    for cases in (10 * MOST_CHECKED, 1_000_001):
        checked = checked_cases(cases)
        assert (checked[0], checked[-1], len(checked)) == (0, cases - 1, MOST_CHECKED)
        assert sorted(set(checked)) == checked


def test_a_range_of_runs_is_built_as_each_of_them_alone() -> None:
    made = campaign()
    assert [*made.planned(5, 17)] == [made.run(index) for index in range(5, 17)]


def test_a_run_that_cannot_be_built_is_named_and_does_not_end_the_others() -> None:
    made = campaign(grid={'duration_s': [1.0, 3.0], 'control_start_s': [0.6, 2.4]})
    runs = [*made.planned(0, made.runs)]
    left_out = [run.index for run in runs if isinstance(run, ImpossibleRow)]
    assert left_out == [3, 4, 5, 9, 10, 11, 15, 16, 17, 21, 22, 23]
    with refused(ParameterError, 'score_window_s') as caught:
        made.run(4)
    assert caught.value.place.startswith('run 4 (duration_s 1.0, control_start_s 2.4, vehicle.')


def test_a_controller_that_does_not_suit_the_run_is_refused_before_the_first_run() -> None:
    made = campaign(grid={'controllers.ls8.width': [1.0, 2.0]})
    with pytest.raises(ParameterError) as caught:
        made.require_sound()
    assert caught.value.key == 'controllers.ls8.width'


def test_two_controllers_of_one_name_are_refused(tmp_path: Path) -> None:
    for name in ('a.yaml', 'b.yaml'):
        (tmp_path / name).write_text(
            'name: same\nunits: {input: rpm, output: N m}\n'
            'transfer_function: {gain: -1.0, numerator: [], denominator: [2.0]}\n',
            encoding='utf-8',
        )
    with refused(ParameterError, 'controllers'):
        campaign(tmp_path, controllers=['a.yaml', 'b.yaml'])
