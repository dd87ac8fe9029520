# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The verdict table and the Pareto view of the report, from entries alone."""

import pytest
from made_scores import made_scores

from ddct_bringup.metrics.catalogue import CRITERIA
from ddct_bringup.report.page_parts import unit_text, value_text
from ddct_bringup.report.pareto import DEFAULT_PAIR, non_dominated, pair_key, pareto_view
from ddct_bringup.report.score_tables import NOT_JUDGED, verdict_rows
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.verdict import verdict_of


def run(state='engaged', **values):
    """Return a run of `thesis` with these values of its criteria."""
    found = dict.fromkeys(criterion.key for criterion in CRITERIA) | values
    exists = dict.fromkeys(found, True)
    verdict = verdict_of(state, found, packaged_limits(), 'thesis', exists=exists)
    return ScoredRecording(made_scores(verdict=verdict))


FAILED = ScoredRecording(made_scores(valid=False, reason='killed'))


def row_of(name, runs):
    (row,) = [row for row in verdict_rows(runs) if row.criterion.key == name]
    return row


def test_every_criterion_has_a_row_with_its_unit():
    rows = verdict_rows([run()])
    keys = [*(criterion.key for criterion in CRITERIA), 'traction']
    assert [row.criterion.key for row in rows] == keys
    assert unit_text(row_of('releases_after_lock', [run()]).criterion.unit) == ''


def test_a_value_beyond_its_limit_is_marked_and_the_limit_has_its_source():
    row = row_of(
        'weighted_acceleration',
        [FAILED, run(weighted_acceleration=0.9), run(weighted_acceleration=0.3)],
    )
    assert [cell.state for cell in row.cells] == ['no_limit', 'beyond', 'within']
    assert [cell.text for cell in row.cells] == ['–', '0.9', '0.3']
    assert row.limit == '0.315'
    assert row.source.startswith('ISO 2631-1')
    assert row_of('torque_dip', [run(torque_dip=1.0)]).limit == ''


def test_a_convention_is_marked_and_gives_its_reason():
    row = row_of('releases_after_lock', [run(releases_after_lock=2)])
    assert (row.convention, row.cells[0].state) == (True, 'beyond')
    assert row.source.startswith('convention: an engagement ends with the lock')
    assert not row_of('weighted_acceleration', [run(weighted_acceleration=0.9)]).convention


def test_every_dash_has_its_reason():
    row = row_of('judder', [run(), FAILED, run(judder=1.0)])
    assert [cell.why_dash for cell in row.cells] == [row.criterion.undefined, NOT_JUDGED, '']
    assert row.reasons == row.criterion.undefined
    assert not row_of('judder', [FAILED, run(judder=1.0)]).reasons


def test_large_values_keep_every_digit_before_the_point():
    values = (None, 0.07461, 10636.4, 2.2623e14)
    assert [value_text(each) for each in values] == ['–', '0.07461', '10636', '2.262e+14']


def test_a_run_is_dominated_by_one_better_in_one_criterion_and_as_good_in_the_other():
    points = {0: (1.0, 3.0), 1: (2.0, 2.0), 2: (2.0, 3.0), 3: (1.0, 3.0), 4: (3.0, 1.0)}
    assert non_dominated(points) == [0, 1, 3, 4]
    assert non_dominated({}) == []


def test_only_engaged_runs_compete_and_magnitudes_count():
    runs = [
        run('stalled', slip_acceleration_at_lock=-1.0, friction_energy=5.0),
        run(slip_acceleration_at_lock=-90.0, friction_energy=900.0),
        FAILED,
        run(slip_acceleration_at_lock=20.0, friction_energy=800.0),
    ]
    view = pareto_view(runs)
    assert view is not None
    assert view.fronts['friction_energy slip_acceleration_at_lock'] == [3]
    assert view.fronts['friction_energy friction_energy'] == [3]
    assert list(view.criteria['friction_energy'].places) == [0, 1, 3]


def test_the_view_opens_with_energy_and_jerk_where_runs_have_them():
    runs = [run(mean_jerk=each, peak_jerk=each, friction_energy=1.0 / each) for each in (1.0, 2.0)]
    view = pareto_view(runs)
    assert view is not None
    assert view.default == DEFAULT_PAIR
    assert view.fronts[pair_key(*DEFAULT_PAIR)] == [0, 1]
    without = pareto_view([run(mean_jerk=1.0, judder=1.0), run(mean_jerk=2.0, judder=2.0)])
    assert without is not None
    assert without.default == ('mean_jerk', 'judder')


@pytest.mark.parametrize('runs', [[run(judder=1.0)], [run(), run()], [FAILED]])
def test_there_is_no_view_without_two_runs_in_two_criteria(runs):
    assert pareto_view(runs) is None


@pytest.mark.parametrize('values', [(900.0, 1000.0), (0.0, 0.0), (7.0, 7.0), (1e-9, 3e-9)])
def test_an_axis_has_every_run_and_round_numbers_at_their_places(values):
    view = pareto_view([run(judder=each, torque_dip=each) for each in values])
    assert view is not None
    axis = view.criteria['judder']
    assert all(0.0 < place < 1.0 for place in axis.places.values())
    assert 2 <= len(axis.ticks) <= 7
    assert all(0.0 <= place <= 1.0 for _, place in axis.ticks)
    if values[0] != values[1]:
        scale = (axis.places[1] - axis.places[0]) / (values[1] - values[0])
        for text, place in axis.ticks:
            expected = axis.places[0] + scale * (float(text) - values[0])
            assert place == pytest.approx(expected, abs=1e-3)
