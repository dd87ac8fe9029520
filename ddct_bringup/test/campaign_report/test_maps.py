# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Maps: the content of each cell and point, and the common scale of colours."""

from typing import Any

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.campaign_report.maps import MOST_POINTS, campaign_maps
from ddct_bringup.campaign_report.maps_figure import maps_drawing
from ddct_bringup.evaluation.grouped_rows import GroupedRows
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.files.json_records import to_json

WEAR, MASS, SLOPE = 'wear_gain', 'vehicle.mass_kg', 'load.slope_rad'
JERK = 'peak_jerk_m_s3'


def maps_of(results: GroupedRows) -> Any:
    found = campaign_maps(results)
    assert found is not None
    return to_json(found)


def test_every_cell_of_the_grid_is_there_with_its_state_value_and_index():
    states = [ENGAGED, 'stalled', INVALID, ENGAGED]
    varied = {WEAR: [0.8, 0.8, 1.0, 1.0], MASS: [1300.0, 1500.0] * 2}
    found = maps_of(made_results(states, varied, {JERK: [4.0, 90.0, 5.0, -6.0]}))
    (drawn,) = found['maps']
    assert drawn['keys'] == [WEAR, MASS]
    (panel,) = drawn['panels']
    assert panel['at'] == [[0.8, 0.8, 1.0, 1.0], [1300.0, 1500.0, 1300.0, 1500.0]]
    assert panel['state'] == states
    assert panel['values'][JERK] == [4.0, 90.0, None, -6.0]
    assert drawn['extent'] == 'all 4 runs'
    assert panel['index'] == [0, 1, 2, 3]


@pytest.mark.slow
def test_cells_and_points_of_a_map_have_a_text_at_the_pointer_and_can_be_tapped():
    maps = campaign_maps(made_results([ENGAGED] * 2, {WEAR: [0.8, 1.0]}, {JERK: [4.0, 7.0]}))
    assert maps is not None
    (drawn,) = maps_drawing(maps, 'replay INDEX').figures.values()
    tools = {type(tool).__name__: tool for tool in drawn.toolbar.tools}
    for name in ('HoverTool', 'TapTool'):
        assert [shape.name for shape in tools[name].renderers] == ['cells', 'points']
    assert tools['HoverTool'].tooltips == [('', '@text')]


def test_the_scale_is_one_for_all_controllers_and_that_of_engaged_runs():
    results = made_results(
        [ENGAGED, ENGAGED, ENGAGED, 'withheld'],
        {WEAR: [0.8, 1.0, 0.8, 1.0]},
        {JERK: [4.0, 7.0, -9.0, 500.0]},
        controllers=['pi', 'pi', 'ls8', 'ls8'],
    )
    found = maps_of(results)
    assert [(each['low'], each['high']) for each in found['quantities']] == [(4.0, 9.0)]
    assert found['groups'] == ['pi', 'ls8']
    assert [panel['values'][JERK] for panel in found['maps'][0]['panels']] == [[4, 7], [-9, 500]]


def test_a_cell_of_several_samples_counts_them_and_shows_the_worst():
    results = made_results(
        [ENGAGED, 'stalled', ENGAGED, ENGAGED],
        {WEAR: [0.8, 0.8, 1.0, 1.0], MASS: [800.0] * 2 + [1e3] * 2, SLOPE: [0.0, 0.1, 0.0, 0.1]},
        {JERK: [4.0, 3.0, 5.0, 6.0]},
        random=[SLOPE],
        nominal={WEAR: 1.0, MASS: 1000.0, SLOPE: 0.0},
    )
    found = maps_of(results)
    assert found['quantities'][0] == {
        'key': 'failed_share',
        'title': 'share of failed engagements',
        'low': 0.0,
        'high': 1.0,
    }
    (panel,) = found['maps'][0]['panels']
    assert (panel['runs'], panel['failed'], panel['state']) == (
        [2, 2],
        [1, 0],
        ['stalled', ENGAGED],
    )
    assert panel['values'][JERK] == [4.0, 6.0]
    assert panel['rows'][JERK] == [0, 3]


def test_the_other_numbers_of_the_grid_are_at_the_value_nearest_to_nominal():
    states = [ENGAGED] * 8
    varied = {WEAR: [0.8] * 4 + [1.0] * 4, MASS: [1.0, 1.0, 2.0, 2.0] * 2, SLOPE: [0.0, 0.1] * 4}
    found = maps_of(
        made_results(states, varied, {JERK: [1.0] * 8}, nominal={WEAR: 1.0, MASS: 2.0})
    )
    assert [each['keys'] for each in found['maps']] == [[WEAR, MASS], [WEAR, SLOPE], [MASS, SLOPE]]
    assert found['maps'][2]['others'] == {WEAR: 1.0}
    assert found['maps'][2]['panels'][0]['index'] == [4, 5, 6, 7]
    assert found['maps'][2]['extent'] == '4 of 8 runs'


def sampled(runs: int) -> GroupedRows:
    """Return runs over three keys that were drawn at random; the last tenth of them fails."""
    places = np.arange(runs)
    varied = {WEAR: 1.0 + 0.001 * places, MASS: places % 7.0, SLOPE: places % 5.0}
    states = [ENGAGED if run < 0.9 * runs else 'stalled' for run in range(runs)]
    return made_results(
        states,
        {key: values.tolist() for key, values in varied.items()},
        {JERK: places.tolist()},
        random=[*varied],
    )


def test_a_map_of_random_samples_has_all_of_them() -> None:
    found = maps_of(sampled(1250))
    assert [each['keys'] for each in found['maps']] == [[WEAR, MASS], [WEAR, SLOPE], [MASS, SLOPE]]
    assert {each['extent'] for each in found['maps']} == {'all 1250 runs'}
    assert [each['panels'] for each in found['maps']] == [[None]] * 3
    assert not any(each['cells'] for each in found['maps'])
    (points,) = found['points']
    assert points['index'] == list(range(1250))
    assert found['numbers'] == [WEAR, MASS, SLOPE]
    assert points['at'][1][:8] == [0, 1, 2, 3, 4, 5, 6, 0]


def test_of_too_many_samples_a_part_from_first_to_last_is_drawn() -> None:
    runs = 2 * MOST_POINTS + 500
    found = maps_of(sampled(runs))
    assert {each['extent'] for each in found['maps']} == {f'{MOST_POINTS} of {runs} runs'}
    (points,) = found['points']
    assert len(points['index']) == MOST_POINTS
    assert points['index'][0] == 0
    assert points['index'][-1] > runs - 4
    assert points['state'].count('stalled') == pytest.approx(MOST_POINTS / 10, abs=2)


def test_samples_at_points_of_a_grid_are_drawn_where_the_grid_is_at_its_start() -> None:
    varied = {MASS: [1.0, 1.0, 2.0, 2.0], WEAR: [0.7, 0.8, 0.9, 1.0], SLOPE: [0.1, 0.2, 0.3, 0.4]}
    results = made_results(
        [ENGAGED] * 4, varied, {JERK: [1.0] * 4}, random=[WEAR, SLOPE], nominal={MASS: 2.0}
    )
    found = maps_of(results)
    by_keys = {tuple(each['keys']): each for each in found['maps']}
    assert by_keys[MASS, WEAR]['panels'] == [None]
    part = by_keys[WEAR, SLOPE]
    assert (part['others'], part['extent']) == ({MASS: 2.0}, '2 of 4 runs')
    assert part['panels'] == [[2, 3]]


def test_a_cell_with_a_late_lock_is_a_failed_cell() -> None:
    mass = [800.0] * 2 + [1000.0] * 2
    varied = {WEAR: [0.8, 0.8, 1.0, 1.0], MASS: mass, SLOPE: [0.0, 0.1, 0.0, 0.1]}
    states = [ENGAGED, 'late', ENGAGED, ENGAGED]
    results = made_results(states, varied, {JERK: [1.0] * 4}, random=[SLOPE])
    (panel,) = maps_of(results)['maps'][0]['panels']
    assert (panel['failed'], panel['state']) == ([1, 0], ['late', ENGAGED])


def test_keys_that_do_not_vary_have_no_map():
    results = made_results([ENGAGED, ENGAGED], {WEAR: [1.0, 1.0]}, {JERK: [1.0, 2.0]})
    assert campaign_maps(results) is None
