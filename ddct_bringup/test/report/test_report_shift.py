# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page and the tables of gear shifts: both clutches, phases, scores, handovers."""

import io
import re
from typing import Any

import numpy as np
import pytest
from drawn_charts import drawn_charts, leave_out_time_charts
from made_scores import made_scores

from ddct_bringup.campaign.rows import METRIC_COLUMNS, scored_headless
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.report.page import report_page
from ddct_bringup.report.page_runs import chart_runs, page_runs
from ddct_bringup.report.phase_lanes import LANES, shift_spans
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.scores.comparison_table import print_comparison
from ddct_bringup.scores.document import run_entry
from ddct_bringup.scores.run_table import (
    FIGURE_COLUMNS,
    figure_columns,
    identifying_columns,
    print_runs,
)
from ddct_bringup.scores.scored_recording import ScoredRecording, simulate_and_score
from ddct_bringup.sweep.axis import axis_of
from ddct_bringup.sweep.sweep import Sweep
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.timebase import time_of_step
from ddct_plant.files.json_records import to_json
from ddct_plant.scenario.file import ScenarioFile, load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

HANDOVERS = ('timed', 'model')
OF_SHIFT = [each for each in METRICS.values() if each.of_shift]
DIP, FLARE, TIE_UP = (
    FIGURE_COLUMNS[each] for each in ('torque_dip_percent', 'flare_rad_s', 'tie_up_work_j')
)


def settings(handover: str) -> RunSettings:
    """Return an upshift with a torque cut."""
    scenario = load_scenario('upshift', ['shift.torque_cut_n_m=20'])
    return RunSettings(KnownSettings(scenario, handover=handover))


@pytest.fixture(scope='module')
def runs() -> list[ScoredRecording]:
    """Return the shift of `pi` with two handovers."""
    plans = [RunPlan(settings(each), 'pi', 'headless') for each in HANDOVERS]
    return [simulate_and_score(plan, packaged_limits()) for plan in plans]


@pytest.fixture(scope='module')
def charts(runs: list[ScoredRecording]) -> dict[str, Any]:
    """Return the charts of the page by name, as it loads them."""
    return drawn_charts(chart_runs(page_runs(runs)))


def drawn(chart: Any, run: int, column: str) -> np.ndarray:
    """Return a column of the data of a run's line."""
    lines = [each for each in chart.renderers if each.glyph.__class__.__name__ == 'Line']
    of_run = [line for line in lines if line.tags[0]['runs'] == [run]]
    return np.asarray(of_run[0].data_source.data[column])


def test_torques_slips_share_and_cut_of_the_off_going_side_have_their_charts(runs, charts):
    for index, run in enumerate(runs):
        signals = run.recording.trajectory
        for key, expected in (
            ('C_1_request', signals.off_going_torque_request),
            ('C_1_transmitted', signals.off_going_transmitted_torque),
            ('C_1_transmitted_thin', signals.at_tick('off_going_clutch_torque')),
            ('w_d1', signals.off_going_slip_speed * 30.0 / np.pi),
            ('handover_share', signals.handover_share),
            ('torque_cut', signals.torque_cut),
            ('driveshaft_torque', signals.driveshaft_effort),
            ('temperature_1', signals.off_going_clutch_temperature),
        ):
            shown = drawn(charts[key.removesuffix('_thin')], index, key)
            np.testing.assert_allclose(shown, expected, rtol=1e-6, atol=1e-6)


def test_each_shift_has_a_row_of_its_phases_and_one_of_each_clutch(runs, charts):
    labels = charts[LANES].yaxis[0].major_label_overrides
    of_run = ('{0}', '{0}: on-coming', '{0}: off-going')
    names = [each.format(f'pi, handover {name}') for name in HANDOVERS for each in of_run]
    assert list(labels.values()) == names
    metrics = runs[1].scores.metrics
    course = chart_runs(page_runs(runs))[1].course
    torque, inertia = shift_spans(course)
    assert torque == (0.3, 0.5, 'torque phase')
    assert inertia[1] - inertia[0] == pytest.approx(metrics['inertia_phase_s'], abs=1e-12)
    assert inertia[2] == 'inertia phase'


def test_every_chart_marks_the_start_of_the_shift_and_of_feedback(runs, charts):
    expected = {
        0.3,
        *(time_of_step(run.course.feedback_start) for run in chart_runs(page_runs(runs))),
    }
    for chart in charts.values():
        spans = [each for each in chart.center if each.__class__.__name__ == 'Span']
        assert {span.location for span in spans} == expected


def test_the_page_has_the_metrics_of_the_shift_and_its_words_and_other_pages_have_neither(
    runs, monkeypatch
):
    leave_out_time_charts(monkeypatch)
    html = report_page(runs, [], packaged_limits())
    for metric in OF_SHIFT:
        assert html.count(f'data-metric="{metric.key}"') == len(runs)
    assert '<h1>Gear shift</h1>' in html
    assert 'off-going' in html and 'the shift starts' in html
    assert re.search(
        r'<title>Gear shift, upshift.*: pi, handover timed, pi, handover model<', html
    )
    other = report_page(
        [
            simulate_and_score(
                RunPlan(RunSettings(KnownSettings(load_scenario('thesis'))), 'pi', 'headless'),
                packaged_limits(),
            )
        ],
        [],
        packaged_limits(),
    )
    assert '<h1>Clutch engagement</h1>' in other
    assert 'off-going' not in other.partition('<script>')[0]
    assert not any(metric.key in other for metric in OF_SHIFT)


def test_the_terminal_has_columns_of_the_shift_and_the_title_names_the_handover(runs):
    stream = io.StringIO()
    print_comparison([run.scores for run in runs[:1]], settings('timed'), [], stream)
    table = stream.getvalue()
    conditions = 'detailed, wear gain 1, handover timed, off-going wear gain 1, lockstep'
    assert conditions in ' '.join(table.split())
    row = next(line for line in table.splitlines() if line.split()[:1] == ['pi'])
    metrics = runs[0].scores.metrics
    assert row.split()[1] == f'{metrics["time_to_final_lock_s"]:.2f}'
    assert f'{metrics["torque_dip_percent"]:.0f}' in row.split()
    assert row.split()[-1] == runs[0].scores.state == 'engaged'
    shifts, other = [run.scores for run in runs], made_scores(releases=0, steps=300)
    for columns, has in ((figure_columns(shifts), True), (figure_columns([other]), False)):
        assert [each in columns for each in (DIP, FLARE, TIE_UP)] == [has] * 3
    assert figure_columns([*shifts, other]) == figure_columns(shifts)


def test_a_table_of_recorded_shifts_has_their_handovers_and_off_going_wear(runs):
    stream, shifts = io.StringIO(), [run.scores for run in runs]
    print_runs(shifts, (*identifying_columns(shifts), *figure_columns(shifts)), stream)
    rows = [line.split()[:5] for line in stream.getvalue().splitlines()]
    for handover in HANDOVERS:
        assert rows.count(['pi', 'pi', '1', '1', handover]) == 1
    other = identifying_columns([made_scores(steps=300)])
    assert [column.heading for column in other] == ['bag', 'controller', 'wear']


def test_the_heading_of_a_sweep_has_handover_and_off_going_wear_unless_they_vary():
    fixed = {'handover': 'timed', 'off_going_wear_gain': 0.8}
    base = RunBase(ScenarioFile.read('upshift'), {}, fixed, labels=())
    axes = [axis_of('wear_gain=0.9,1'), axis_of('handover=slip,model')]
    found = [Sweep(base, axes[:n], ['pi'], packaged_limits()).conditions for n in (1, 2)]
    upshift = 'upshift; detailed'
    assert found == [
        f'{upshift}, handover timed, off-going wear gain 0.8',
        f'{upshift}, off-going wear gain 0.8',
    ]


def test_a_campaign_has_the_scores_of_the_single_run_to_the_last_bit(runs):
    found = scored_headless(settings('model'), 'pi', packaged_limits())
    single = runs[1].scores
    assert {key: found.metrics[key] for key in METRIC_COLUMNS} == {
        key: single.metrics[key] for key in METRIC_COLUMNS
    }
    assert found.state == single.state
    assert OF_SHIFT and {metric.key for metric in OF_SHIFT} <= set(METRIC_COLUMNS)


def test_scores_of_a_shift_name_its_handover_and_those_of_other_runs_do_not(runs):
    entry = to_json(run_entry(runs[0].scores))
    assert (entry['handover'], entry['off_going_wear_gain']) == ('timed', 1.0)
    assert 'handover' not in to_json(run_entry(made_scores()))
