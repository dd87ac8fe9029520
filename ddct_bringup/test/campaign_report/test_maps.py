"""Maps: what each cell and point says, and the one scale of colours that all share."""

from typing import Any

from made_results import made_results

from ddct_bringup.campaign_report.maps import MOST_POINTS, campaign_maps
from ddct_bringup.campaign_report.results import Results
from ddct_bringup.verdict.state import ENGAGED, INVALID

WEAR, MASS, SLOPE = 'wear_gain', 'vehicle.mass_kg', 'load.slope_rad'
JERK = 'peak_jerk_m_s3'


def maps_of(results: Results) -> dict[str, Any]:
    found = campaign_maps(results)
    assert found is not None
    return found


def test_every_cell_of_the_grid_is_there_with_its_state_value_and_index():
    states = [ENGAGED, 'stalled', INVALID, ENGAGED]
    varied = {WEAR: [0.8, 0.8, 1.0, 1.0], MASS: [1300.0, 1500.0] * 2}
    found = maps_of(made_results(states, varied, {JERK: [4.0, 90.0, 5.0, -6.0]}))
    (drawn,) = found['maps']
    assert drawn['keys'] == [WEAR, MASS]
    (panel,) = drawn['panels']
    assert panel['at'] == [[0.8, 0.8, 1.0, 1.0], [1300.0, 1500.0, 1300.0, 1500.0]]
    assert panel['state'] == states
    assert panel['values'][JERK] == [4.0, 90.0, None, 6.0]
    assert panel['index'] == [0, 1, 2, 3]


def test_the_scale_is_one_for_all_controllers_and_that_of_engaged_runs():
    results = made_results(
        [ENGAGED, ENGAGED, ENGAGED, 'runaway'],
        {WEAR: [0.8, 1.0, 0.8, 1.0]},
        {JERK: [4.0, 7.0, -9.0, 500.0]},
        controllers=['pi', 'pi', 'ls8', 'ls8'],
    )
    found = maps_of(results)
    assert [(each['low'], each['high']) for each in found['quantities']] == [(4.0, 9.0)]
    assert found['groups'] == ['pi', 'ls8']
    assert [panel['values'][JERK] for panel in found['maps'][0]['panels']] == [[4, 7], [9, 500]]


def test_a_cell_of_several_samples_counts_them_and_shows_the_worst():
    results = made_results(
        [ENGAGED, 'stalled', ENGAGED, ENGAGED],
        {WEAR: [0.8, 0.8, 1.0, 1.0], SLOPE: [0.0, 0.1, 0.0, 0.1]},
        {JERK: [4.0, 3.0, 5.0, 6.0]},
        random=[SLOPE],
    )
    results.columns[MASS] = results.columns[WEAR] * 1000.0
    found = maps_of(
        Results(results.columns, [WEAR, MASS], [SLOPE], {WEAR: 1.0, MASS: 1000.0, SLOPE: 0.0})
    )
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


def test_random_samples_are_points_and_no_more_than_a_page_can_show():
    runs = MOST_POINTS + 5
    varied = {WEAR: [1.0 + 0.001 * run for run in range(runs)]}
    results = made_results([ENGAGED] * runs, varied, {JERK: [1.0] * runs}, random=[WEAR])
    (drawn,) = maps_of(results)['maps']
    assert (drawn['keys'], drawn['cells']) == ([WEAR], False)
    assert drawn['panels'][0]['index'] == list(range(MOST_POINTS))


def test_nothing_is_drawn_over_what_does_not_vary():
    results = made_results([ENGAGED, ENGAGED], {WEAR: [1.0, 1.0]}, {JERK: [1.0, 2.0]})
    assert campaign_maps(results) is None
