# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The studies of the admissible scenarios, here of few of them; all are in tests/nightly."""

import pytest

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.reproduction.calibration.predicted_values import OPEN_LOOP
from ddct_bringup.reproduction.studies import admissible_scenarios as module
from ddct_bringup.reproduction.studies.admissible_scenarios import (
    admissible_scenarios,
    prediction_ranges,
    score_windows,
    worn_ranges,
)
from ddct_bringup.thesis.predictions import kept_predictions
from ddct_bringup.thesis.table_5_1 import FORMS

pytestmark = pytest.mark.slow
END_S = 1.7
"""End of the score window of the frozen scenario, in s."""


@pytest.fixture
def one_member(monkeypatch):
    """Let the scenario in the middle of the frozen window be the only one."""
    (one,) = [each for each in module.members() if each.name == f'window_{END_S}']
    monkeypatch.setattr(module, 'members', lambda: [one])
    return one


def test_no_scenario_has_a_whole_predicted_row():
    remarks = prediction_ranges().remarks[1:]
    assert [remark.split(':')[0] for remark in remarks] == ['MPC3', 'MPC4']
    assert all(' 0 hit all three figures' in remark for remark in remarks)


def test_both_deviations_of_the_clutch_without_feedback_have_a_range_and_no_print():
    alone = [row for row in prediction_ranges().rows if row[0] == OPEN_LOOP]
    kept = kept_predictions().predictions
    for row, name in zip(alone, ('torsion_speed_std_rpm', 'acceleration_std_m_s2'), strict=True):
        found = kept[f'5.1 {OPEN_LOOP} {name}']
        assert row[1:3] == (METRICS[name].heading, f'{found.frozen:{FORMS[name]}}')
        assert row[3:] == (found.text(FORMS[name]), '-', '-', '-')


def test_a_range_has_the_value_of_the_frozen_scenario_and_those_of_all():
    found = kept_predictions().predictions['5.2 hinf2 slip_rad_s 0.7']
    (row,) = [
        row for row in worn_ranges().rows if row[:2] == ('hinf2', '0.7') and 'rad/s' in row[2]
    ]
    assert row[3:] == (f'{found.frozen:.1f}', found.text('.1f'))


def test_the_fitted_values_of_a_scenario_are_its_own(one_member):
    thesis, row = admissible_scenarios().rows
    assert (thesis[0], row[0]) == ('thesis', one_member.name)
    assert float(row[1]) == END_S
    assert float(row[5]) == pytest.approx(one_member.reference.slope_rad_s2, abs=0.05)
    assert float(row[-1]) < float(thesis[-1])


def test_quiet_before_mpc4_acts_is_as_printed_for_the_frozen_end_of_the_window(one_member):
    study = score_windows()
    frozen, centre, fitted, _ = study.rows
    assert [row[:2] for row in (frozen, centre, fitted)] == [
        (f'{END_S}', 'frozen'),
        (f'{END_S}', 'centre'),
        (f'{END_S}', 'least squares'),
    ]
    assert float(centre[-1]) == pytest.approx(0.2, rel=0.15)
    assert float(fitted[2]) == pytest.approx(float(frozen[2]), abs=0.2)
