# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`scores.json` is read as it was written; a file of another version is refused."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from by_schema import require_schema
from made_scores import made_limit, made_scores

from ddct_bringup.bag.run_facts import ShiftConditions
from ddct_bringup.metrics.catalogue import FIGURES, METRICS
from ddct_bringup.scores.document import (
    RunEntry,
    ScoresDocument,
    ShiftEntry,
    read_scores,
    run_entry,
    scores_document,
)
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import run_without_score
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import from_json, to_json
from ddct_plant.signals.gain_changes import GainChange

RUN = made_scores(
    'ls8',
    scenario_changes=('load.slope_rad=0.05',),
    gain_changes=(GainChange('proportional_gain', 0.103, 0.25, 62),),
    state='late',
    why='the plates are locked for the last 0.2 s',
    limits=(made_limit('judder_rpm', 7.0, 6.0, convention=True),),
    null_reasons={'torque_late_s': 'there is no demand'},
    least_is_bound=False,
    **{**dict.fromkeys(METRICS, 1.5), 'torque_late_s': None},
)


def content(*runs: ScoredRun) -> Any:
    """Return the content of the file of runs."""
    return to_json(scores_document(runs, packaged_limits()))


def read(folder: Path, document: Any) -> list[ScoredRun]:
    """Return the runs of a file with this content."""
    (folder / 'scores.json').write_text(json.dumps(document), encoding='utf-8')
    return read_scores(folder / 'scores.json')


def test_scores_are_read_as_they_were_written(tmp_path: Path) -> None:
    runs = [RUN, run_without_score('broken/pi', None, 'unfinished')]
    require_schema('scores', content(*runs))
    found = read(tmp_path, content(*runs))
    assert content(*found) == content(*runs)
    assert replace(found[0], facts=None) == replace(RUN, facts=None)
    assert (found[0].controller, found[1].facts) == ('ls8', None)
    assert (found[1].state, found[1].limits) == ('invalid', ())


def test_the_entry_of_a_run_has_its_state_figures_metrics_and_limits() -> None:
    document = content(RUN)
    (entry,) = document['runs']
    assert document['schema_version'] == 4
    assert (entry['state'], entry['why']) == ('late', 'the plates are locked for the last 0.2 s')
    assert list(entry['figures']) == [*(each.key for each in FIGURES), 'least_is_bound']
    assert entry['figures']['torque_late_s'] is None
    assert entry['null_reasons'] == {'torque_late_s': 'there is no demand'}
    assert {*entry['metrics']} == {*METRICS} - {*entry['figures']}
    assert entry['limits'] == [
        {
            'name': 'judder_rpm',
            'value': 7.0,
            'limit': 6.0,
            'unit': 'rpm',
            'source': 'A, 1',
            'convention': True,
        }
    ]
    assert not {'verdict', 'over_floor'} & {*entry}


def test_a_run_that_is_no_gear_shift_has_no_figure_of_one() -> None:
    values = {key: None if each.of_shift else 1.0 for key, each in METRICS.items()}
    nulls = {key: 'the run is no gear shift' for key, value in values.items() if value is None}
    (entry,) = content(made_scores(null_reasons=nulls, **values))['runs']
    of_shift = {each.key for each in METRICS.values() if each.of_shift}
    for part in ('figures', 'metrics', 'null_reasons'):
        assert not of_shift & {*entry[part]}


def test_a_gear_shift_is_read_as_it_was_written(tmp_path: Path) -> None:
    entry = to_json(run_entry(RUN))
    assert isinstance(run_entry(RUN), RunEntry)
    shift = {'off_going_wear_gain': 0.9, 'handover': 'model'}
    document = {**content(), 'runs': [{**entry, **shift}]}
    require_schema('scores', document)
    found = from_json(ScoresDocument, document, 'x')
    (read_entry,) = found.runs
    assert isinstance(read_entry, ShiftEntry)
    assert read_entry.shift == ShiftConditions(0.9, 'model')


@pytest.mark.parametrize(
    ('document', 'complaint'),
    [
        ([], 'it is a list: give an object'),
        ({'runs': []}, 'the key schema_version is missing'),
        ({'schema_version': 3, 'limits': {}, 'runs': []}, 'schema_version is 3: give 4'),
        ({'schema_version': 4, 'limits': {}}, 'the key runs is missing'),
        ({**content(RUN), 'verdict': 1}, 'unknown key verdict'),
    ],
)
def test_another_file_is_refused_in_one_line(
    tmp_path: Path, document: Any, complaint: str
) -> None:
    with pytest.raises(DdctError, match=complaint) as caught:
        read(tmp_path, document)
    assert str(caught.value).startswith(str(tmp_path / 'scores.json'))
    assert str(caught.value).endswith(': score the bags again with ddct score')
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize(
    ('key', 'value', 'complaint'),
    [
        ('valid', 'yes', r"runs\[0\].valid is 'yes': give true or false"),
        ('limits', [{'name': 'x'}], r'the key runs\[0\].limits\[0\].value is missing'),
        ('seed', None, r'runs\[0\].seed is null: give a whole number'),
        ('extra', 1, r'unknown key runs\[0\].extra'),
        ('scenario', 'a b/c', r'runs\[0\]: scenario is'),
        (
            'gain_changes',
            [{'gain': 'k', 'before': 1.0, 'after': 2.0, 'time_s': 0.123}],
            r'runs\[0\].gain_changes\[0\]: time_s',
        ),
    ],
)
def test_a_damaged_run_is_refused_with_its_key(
    tmp_path: Path, key: str, value: Any, complaint: str
) -> None:
    document = content(RUN)
    document['runs'][0][key] = value
    with pytest.raises(DdctError, match=complaint):
        read(tmp_path, document)
