# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Cells of the report's tables, from entries and timing alone."""

import dataclasses
from pathlib import Path

import pytest
from made_run import made_facts, made_run, times
from made_scores import made_scores

from ddct_bringup.bag.recording import Recording
from ddct_bringup.metrics.catalogue import TABLE_5_1
from ddct_bringup.report.evidence import NOT_LINEAR, LoopEvidence, loop_rows, without_evidence
from ddct_bringup.report.run_tables import TICKS, time_place, update_times
from ddct_bringup.report.score_tables import comparable_rows, metric_cells
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_controllers.design.analysis.margins import LoopMargins
from ddct_controllers.workflows.evidence_types import (
    CornersEntry,
    EntryWithoutEvidence,
    LinearEntry,
    PointEntry,
    WearInterval,
    WorstCornerEntry,
)
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS = load_scenario('thesis')


def run(controller='ls8', settings=None, timing=None, valid=True, **metrics):
    facts = made_facts(controller=controller)
    trajectory = made_run(times())
    recording = Recording(Path(), trajectory, facts, settings=settings)
    return ScoredRecording(made_scores(controller, valid=valid, **metrics), recording, timing)


@pytest.mark.parametrize(
    'settings',
    [
        RunSettings(KnownSettings(THESIS), CaseSettings(wear_gain=0.7)),
        RunSettings(KnownSettings(THESIS, architecture='feedforward')),
        RunSettings(KnownSettings(dataclasses.replace(THESIS, duration_s=4.0))),
        None,
    ],
)
def test_other_conditions_than_the_thesis_s_are_not_set_beside_it(settings):
    assert comparable_rows([run(settings=settings)]) == [None]


def test_the_thesis_s_conditions_are():
    rows = comparable_rows(
        [
            run('ls8', RunSettings(KnownSettings(THESIS))),
            run('ls1', RunSettings(KnownSettings(THESIS))),
        ]
    )
    assert [row and row.label for row in rows] == ['LS8', None]


def test_a_cell_has_the_computed_value_the_printed_one_and_their_difference():
    runs = [
        run('ls8', RunSettings(KnownSettings(THESIS)), engagement_time_s=0.781),
        run('ls1', RunSettings(KnownSettings(THESIS)), engagement_time_s=1.562),
        run('pi'),
    ]
    cells = metric_cells(TABLE_5_1[0], runs, comparable_rows(runs))
    assert (cells[0].value, cells[0].text, cells[0].share) == (0.781, '0.781', 0.5)
    assert (cells[0].thesis_text, cells[0].difference) == ('0.71', '+10 %')
    assert cells[0].thesis_share == pytest.approx(0.71 / 1.562)
    assert (cells[1].share, cells[1].thesis) == (1.0, None)
    assert (cells[2].value, cells[2].text, cells[2].share) == (None, '–', 0.0)


def test_a_predicted_value_has_its_verdict_and_a_calibrated_one_has_not():
    runs = [
        run('mpc3', RunSettings(KnownSettings(THESIS)), engagement_time_s=0.62),
        run('mpc4', RunSettings(KnownSettings(THESIS))),
        run('ls8', RunSettings(KnownSettings(THESIS)), engagement_time_s=0.71),
    ]
    predicted, undefined, calibrated = metric_cells(TABLE_5_1[0], runs, comparable_rows(runs))
    assert predicted.verdict == 'hit'
    assert undefined.verdict == 'miss'
    assert calibrated.verdict == ''


def test_a_run_that_is_not_valid_neither_hits_nor_misses():
    hit = run('mpc3', RunSettings(KnownSettings(THESIS)), engagement_time_s=0.62)
    failed = run('mpc3', RunSettings(KnownSettings(THESIS)), valid=False, engagement_time_s=0.62)
    runs = [hit, failed]
    cells = metric_cells(TABLE_5_1[0], runs, comparable_rows(runs))
    assert [cell.verdict for cell in cells] == ['hit', '']


def test_a_failed_run_has_no_update_times_even_where_a_timing_was_left():
    assert update_times(run(timing=RunTiming(update_times_us=[10.0, 100.0]))) is None


def test_update_times_lie_on_a_logarithmic_scale():
    timing = RunTiming(update_times_us=[10.0, 100.0, 20000.0], missed_steps=1, resends=2)
    times = update_times(
        run(timing=timing, update_time_median_us=100.0, update_time_p99_us=10000.0)
    )
    assert times is not None
    assert time_place(times.median_us) == pytest.approx(0.4)
    assert time_place(times.p99_us) == time_place(TICKS['10 ms']) == pytest.approx(0.8)
    assert (times.largest_us, times.over_period, times.timing.missed_steps) == (20000.0, 1, 1)


def test_a_run_without_update_times_has_none():
    assert update_times(run()) is None
    assert update_times(run(timing=RunTiming())) is None


def test_evidence_is_shown_at_the_wear_gain_of_the_run():
    ones = LoopMargins(True, *[1.0] * 9)
    points = [
        PointEntry(0.7, ones, None, None, None),
        PointEntry(1.0, LoopMargins(False), None, None, None),
    ]
    corners = CornersEntry(3, None, None, WorstCornerEntry({}, points[1]))
    entry = LinearEntry('pi', True, points[1], WearInterval(0.0, 0.9), points, corners)
    worn, new = loop_rows([LoopEvidence('pi', 0.7, entry), LoopEvidence('pi', 1.0, entry)])
    assert (worn.stable, worn.cells[0]) == (True, (1.0, '1.0'))
    assert (new.stable, new.cells[0]) == (False, (None, '–'))
    assert (new.stable_wear, new.corner_peak, new.corners_unstable) == ('0.00 to 0.90', '–', '3')


def test_controllers_without_evidence_are_named_with_the_reason():
    not_linear = EntryWithoutEvidence('mpc3', False, None, None, None, None)
    evidence = [
        LoopEvidence('mpc3', 0.7, not_linear),
        LoopEvidence('mpc3', 1.0, not_linear),
        LoopEvidence('mpc4', 1.0, not_linear),
        LoopEvidence('mine', 1.0, None, 'unknown controller'),
    ]
    assert loop_rows(evidence) == []
    assert without_evidence(evidence) == {
        NOT_LINEAR: ['mpc3', 'mpc4'],
        'unknown controller': ['mine'],
    }
