# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A damaged file of a benchmark's folder is refused in one line that names it."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest
from verified import edit_manifest

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.plan import BenchmarkPlan, RecordedBenchmark
from ddct_bringup.benchmark.release import ROWS, ReleaseRows
from ddct_bringup.benchmark.update_times import read_update_times
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.manifest import BENCHMARK, begin_manifest
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.run.timing_and_failure import TIMING_FILE
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import to_json

Edit = Callable[[dict[str, Any]], object]
RATIO = {'update_time_over_pi': 2.0, 'lowest_ratio': 1.9, 'highest_ratio': 2.1}
TIMES = {**RATIO, 'update_time_median_us': 10.0, 'pi_update_time_median_us': 5.0}


@pytest.mark.parametrize(
    'edit',
    [
        lambda content: content.update(limits=[]),
        lambda content: content.update(quick='yes'),
        lambda content: content.update(judge_seed='1'),
        lambda content: content['controllers'][0].update(chosen=['pi']),
        lambda content: content['controllers'][0].update(digests=['a']),
        lambda content: content['controllers'][0].update(held_out_seed=1.5),
        lambda content: content['cases'].pop('controllers'),
        lambda content: content['cases'].update(controllers=7),
        lambda content: content['cases'].update(seed='1'),
        lambda content: content['cases'].update(car=7),
        lambda content: content.update(left_out=['tip_in']),
        lambda content: content['cases'].update(random=None),
        lambda content: content['cases']['random'].update(samples='3'),
    ],
)
def test_a_manifest_with_a_value_of_another_type_is_refused(tmp_path: Path, edit: Edit) -> None:
    inputs = InputFiles()
    plan = BenchmarkPlan.of([Judged.of('pi')], Cases.packaged(), None, inputs)
    begin_manifest(tmp_path, BENCHMARK, plan, inputs)
    assert RecordedBenchmark.read(tmp_path).plan.controllers[0].name == 'pi'
    edit_manifest(tmp_path, lambda content: edit(content['plan']))
    with pytest.raises(DdctError):
        RecordedBenchmark.read(tmp_path)


def test_update_times_are_whole_or_have_a_reason(tmp_path: Path) -> None:
    failed = {'update_time_over_pi': None, 'reason': 'it failed'}
    content = {'reference': 'pi', 'controllers': {'mine': TIMES, 'other': failed}}
    (tmp_path / TIMING_FILE).write_text(json.dumps(content), encoding='utf-8')
    assert to_json(read_update_times(tmp_path)) == content


@pytest.mark.parametrize(
    'text',
    [
        *('', '\xff', '[]', '{"controllers": []}', '{"controllers": {"mine": 1}}'),
        *(
            json.dumps({'controllers': {'mine': each}})
            for each in (RATIO, {'update_time_over_pi': None})
        ),
        json.dumps({'controllers': {'mine': {**TIMES, 'update_time_over_pi': '2'}}}),
    ],
)
def test_damaged_update_times_are_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / TIMING_FILE).write_bytes(text.encode('latin-1'))
    with pytest.raises(DdctError) as error:
        read_update_times(tmp_path)
    assert error.value.place == str(tmp_path / TIMING_FILE)
    assert str(error.value).endswith('the same command measures the update times again')


def test_rows_with_fewer_cases_than_their_specification_are_refused(tmp_path: Path) -> None:
    table = pa.table({'controller': ['pi'] * 3})
    rows = ReleaseRows(CaseRows(table), Cases.packaged().digest, CodeOrigin.here())
    with pytest.raises(DdctError, match=f'{ROWS} lacks cases: run tools/run benchmark_rows'):
        rows.of(Cases.packaged())
