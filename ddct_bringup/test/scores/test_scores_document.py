# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`scores.json` is read as it was written; that of an earlier version stays readable."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from made_run import made_run, times
from made_scores import made_result, made_scores, made_verdict

from ddct_bringup.metrics.catalogue import CRITERIA, METRICS, OF_SHIFT
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.metric import criterion
from ddct_bringup.scores.document import NO_SUCH_METRIC, read_scores, scores_document
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import run_without_score
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.gain_changes import GainChange

RESULTS = [made_result(each.key, 1.0, 2.0, unit=each.unit) for each in CRITERIA]
RUN = made_scores(
    'ls8',
    scenario_changes=('load.slope_rad=0.05',),
    gain_changes=(GainChange('proportional_gain', 0.103, 0.25, 62),),
    verdict=made_verdict('engaged', 'within', *RESULTS),
    **dict.fromkeys(METRICS, 1.5),
)


def content(*runs: ScoredRun) -> Any:
    """Return the content of the file of runs."""
    return json.loads(json.dumps(scores_document(runs, packaged_limits())))


def read(folder: Path, document: Any) -> list[ScoredRun]:
    """Return the runs of a file with this content."""
    (folder / 'scores.json').write_text(json.dumps(document), encoding='utf-8')
    return read_scores(folder / 'scores.json')


def test_scores_are_read_as_they_were_written(tmp_path: Path) -> None:
    runs = [RUN, run_without_score('broken/pi', None, 'unfinished')]
    found = read(tmp_path, content(*runs))
    assert content(*found) == content(*runs)
    assert found[0].gain_changes == RUN.gain_changes
    assert [replace(each, facts=None) for each in found] == [
        replace(each, facts=None) for each in runs
    ]
    assert (found[0].controller, found[1].facts) == ('ls8', None)


def test_a_metric_that_the_file_does_not_have_is_none_with_its_reason(tmp_path: Path) -> None:
    document = content(RUN)
    entry = document['runs'][0]
    del entry['metrics']['peak_jerk_m_s3']
    entry['verdict']['criteria'] = entry['verdict']['criteria'][1:]
    (run,) = read(tmp_path, document)
    assert run.metrics['peak_jerk_m_s3'] is None
    assert run.not_computed == dict.fromkeys(('peak_jerk_m_s3', CRITERIA[0].key), NO_SUCH_METRIC)


def test_scores_of_schema_version_2_are_readable(tmp_path: Path) -> None:
    document = {**content(RUN), 'schema_version': 2}
    verdict = document['runs'][0]['verdict']
    del verdict['traction']
    for each in verdict['criteria']:
        del each['convention']
    (run,) = read(tmp_path, document)
    assert (run.verdict, run.metrics) == (RUN.verdict, RUN.metrics)


@pytest.mark.parametrize(
    'document', [[], {}, {'runs': []}, {'schema_version': 1, 'runs': []}, {'schema_version': 4}]
)
def test_another_file_is_refused_in_one_line(tmp_path: Path, document: Any) -> None:
    with pytest.raises(DdctError, match='scores.json: not the scores of runs') as caught:
        read(tmp_path, document)
    assert '\n' not in str(caught.value)


def test_a_recording_from_before_a_signal_existed_has_no_value_of_its_criterion() -> None:
    engagement = Engagement(made_run(times()), 60, (60, 170))
    rise = criterion(
        'rise',
        'degC',
        lambda run: run.trajectory.clutch_temperature[-1],
        'temperature at the end',
        'the clutch is linear',
        signals=('clutch_temperature',),
    )
    assert rise.of(engagement) is None


def test_scores_from_before_floors_are_read_without_them(tmp_path: Path) -> None:
    run = replace(RUN, over_floor={'peak_jerk': 2.0, 'mean_jerk': None}, no_floor='why')
    assert read(tmp_path, content(run))[0].over_floor == run.over_floor
    document = content(run)
    for entry in document['runs']:
        del entry['over_floor'], entry['no_floor']
        for result in entry['verdict']['criteria']:
            del result['least'], result['over_floor'], result['least_at_any_lock']
    (found,) = read(tmp_path, document)
    assert (found.over_floor, found.no_floor) == ({}, '')
    assert found.verdict == RUN.verdict


def test_scores_from_before_gear_shifts_have_null_metrics_of_a_shift_without_a_remark(
    tmp_path: Path,
) -> None:
    document = content(RUN)
    for metric in OF_SHIFT:
        del document['runs'][0]['metrics'][metric.key]
    (run,) = read(tmp_path, document)
    assert all(run.metrics[metric.key] is None for metric in OF_SHIFT)
    assert run.not_computed == {}
