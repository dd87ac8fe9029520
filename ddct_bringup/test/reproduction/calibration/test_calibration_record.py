# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The stored record, the scenario file, the page and the simulation agree."""

import importlib.resources
from dataclasses import replace
from pathlib import Path

import pytest
from generator.pages import as_markdown, shown_tables

from ddct_bringup.reproduction.calibration.parameters import (
    FROZEN_GAINS,
    NAMES,
    outside_tolerance,
    pi_growth_rate,
    residual_rows,
    rounded,
)
from ddct_bringup.reproduction.calibration.problem import Problem, row_values
from ddct_bringup.reproduction.calibration.record import drive_text
from ddct_bringup.reproduction.calibration.record_tables import all_tables
from ddct_bringup.reproduction.calibration.record_types import CalibrationRecord, FitEntry
from ddct_plant.files.json_records import json_text, read_json
from ddct_plant.scenario.file import load_scenario

DOCS = Path(__file__).resolve().parents[4] / 'docs'
RECORD = read_json(CalibrationRecord, DOCS / 'thesis' / 'calibration.json')
SCENARIO = load_scenario('thesis')


def values(entry: FitEntry) -> list[float]:
    return [entry.values[name] for name in NAMES]


def test_nine_residuals_are_as_recorded_and_within_five_and_ten_percent():
    rows = residual_rows({row: row_values(SCENARIO, row) for row in ('ls8', 'hinf1', 'pi')})
    assert len(rows) == 9
    for computed, recorded in zip(rows, RECORD.residuals, strict=True):
        assert computed.computed == pytest.approx(recorded.computed, rel=1e-6)
        limit = 0.05 if computed.figure == 'engagement_time_s' else 0.10
        assert abs(computed.computed / recorded.printed - 1.0) <= limit


def test_residual_outside_its_tolerance_is_named():
    first, *others = RECORD.residuals
    assert outside_tolerance(RECORD.residuals) == []
    beyond = replace(first, deviation=-0.051)
    assert outside_tolerance([beyond, *others]) == ['ls8 engagement_time_s -5.1 %']


def test_the_drive_and_the_gains_are_those_of_the_record():
    kept = importlib.resources.files('ddct_plant.scenario') / 'packaged' / 'drives' / 'thesis.yaml'
    assert kept.read_text(encoding='utf-8') == drive_text(RECORD)
    optimum = [entry.value for entry in RECORD.parameters]
    scenario = Problem(RECORD.score_window_s[1]).scenario(rounded(optimum))
    assert scenario == replace(SCENARIO, controllers={'pi': FROZEN_GAINS})


def test_the_record_is_read_and_written_to_the_last_bit():
    text = (DOCS / 'thesis' / 'calibration.json').read_text(encoding='utf-8')
    assert json_text(RECORD) == text


def test_page_has_the_numbers_of_the_record():
    assert shown_tables('calibration') == as_markdown(all_tables(RECORD))


def test_chosen_optimum_is_the_lowest_with_a_stable_pi():
    stable = [
        one
        for one in RECORD.windows + RECORD.starts
        if pi_growth_rate(SCENARIO.driveline, *values(one.fit)[4:]) < 0.0
    ]
    best = min(stable, key=lambda one: one.fit.objective)
    assert best.window_end_s == RECORD.score_window_s[1]
    assert best.fit.objective == pytest.approx(RECORD.objective.value, rel=1e-4)


@pytest.mark.parametrize('row', ['ls8', 'hinf1'])
def test_row_left_out_took_no_part_in_the_fit_that_predicts_it(row):
    """The fit beats the frozen one on the other two rows, and predicts the recorded value."""
    one = next(entry for entry in RECORD.left_out if entry.row == row)
    problem = Problem(RECORD.score_window_s[1])
    predicted = row_values(problem.scenario(values(one.fit)), row)
    assert [predicted[entry.figure] for entry in one.figures] == pytest.approx(
        [entry.computed for entry in one.figures], rel=1e-6
    )
    kept = Problem(problem.window_end_s, rows=tuple({'ls8', 'hinf1', 'pi'} - {row}))
    frozen = [entry.frozen for entry in RECORD.parameters]
    objective = 0.5 * sum(kept.residuals(values(one.fit)) ** 2)
    assert objective == pytest.approx(one.fit.objective, rel=1e-5)
    assert objective < 0.5 * sum(kept.residuals(frozen) ** 2)


def test_only_the_pi_row_is_marked_as_not_predictable():
    assert [one.row for one in RECORD.left_out if one.gains_from_row] == ['pi']


def test_longer_windows_leave_a_sigma_of_ls8_out_of_tolerance_as_on_the_page():
    beyond = [one for one in RECORD.windows if one.pi_stable and one.window_end_s > 1.85]
    assert len(beyond) >= 12
    assert all(one.fit.worst_residual < -1.0 for one in beyond)
    longest = max(beyond, key=lambda one: one.window_end_s)
    figures = row_values(Problem(longest.window_end_s).scenario(values(longest.fit)), 'ls8')
    assert figures['torsion_speed_std_rpm'] < 0.9 * 1.15
