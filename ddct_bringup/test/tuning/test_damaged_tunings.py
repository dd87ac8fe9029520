# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A manifest with a value of another type, and damaged runs, are refused with their file."""

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from verified import edit_manifest

from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.manifest import TUNING, begin_manifest
from ddct_bringup.tuning.plan import RecordedTuning
from ddct_bringup.tuning.tables import RUNS, rows_by_trial
from ddct_plant.base.errors import DdctError

CONTROLLER = {'name': 'pi', 'chosen': 'pi', 'folder': '.', 'digests': {'ddct': 'a'}}
CONTENT: dict[str, Any] = {
    'optuna': '4',
    'limits': {'origin': {'name': 'x'}, 'file': None},
    'controller': CONTROLLER,
    'spec': {},
}


@pytest.mark.parametrize(
    'changes',
    [
        *({'optuna': 1}, {'limits': []}, {'spec': 'x'}, {'controller': 'pi'}),
        {'controller': {**CONTROLLER, 'folder': 1}},
        {'controller': {**CONTROLLER, 'digests': ['a']}},
        {'controller': {'name': 'pi', 'chosen': 'pi', 'folder': '.'}},
    ],
)
def test_a_manifest_with_a_value_of_another_type_is_refused(
    tmp_path: Path, changes: dict[str, Any]
) -> None:
    begin_manifest(tmp_path, TUNING, CONTENT, InputFiles())
    assert RecordedTuning.read(tmp_path).plan.controller.digests == {'ddct': 'a'}
    edit_manifest(tmp_path, lambda content: content['plan'].update(changes))
    with pytest.raises(DdctError, match=f'{tmp_path}, plan: '):
        RecordedTuning.read(tmp_path)


@pytest.mark.parametrize('content', [b'', b'no table', None])
def test_a_damaged_file_of_runs_is_refused(tmp_path: Path, content: bytes | None) -> None:
    file = tmp_path / RUNS
    if content is None:  # a table that is another one
        parquet.write_table(pa.table({'x': [1.0]}), file)
    else:
        file.write_bytes(content)
    with pytest.raises(DdctError) as error:
        rows_by_trial(file)
    assert error.value.place == str(file)
    assert str(error.value).endswith('start the tuning anew')
