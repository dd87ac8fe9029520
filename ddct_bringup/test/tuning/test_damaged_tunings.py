# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A manifest or an entry of a trial with a value of another type is refused, with its file."""

import json
from pathlib import Path
from typing import Any

import pytest
from verified import edit_manifest

from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.manifest import TUNING, begin_manifest
from ddct_bringup.tuning.plan import RecordedTuning
from ddct_bringup.tuning.record import TRIALS, read_entries
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import to_json

CONTROLLER = {'name': 'pi', 'chosen': 'pi', 'folder': '.', 'digests': {'ddct': 'a'}}
CONTENT: dict[str, Any] = {
    'optuna': '4',
    'limits': {'origin': {'name': 'x'}, 'file': None},
    'controller': CONTROLLER,
    'spec': {},
}
ENTRY: dict[str, Any] = {
    **{'number': 0, 'state': 'feasible', 'reason': '', 'runs': 1},
    **{'parameters': {'gain': 0.1}, 'further': {'corner': 1.5, 'other': None}},
    **{'objectives': {}, 'constraints': {}},
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


@pytest.mark.parametrize(
    'content',
    [
        *(7, {'a': 1}, [7], [{}]),
        *([{**ENTRY, 'number': '0'}], [{**ENTRY, 'number': True}], [{**ENTRY, 'reason': 1}]),
        *([{**ENTRY, 'state': 'best'}], [{**ENTRY, 'state': []}], [{**ENTRY, 'further': None}]),
        *([{**ENTRY, 'parameters': ['gain']}], [{**ENTRY, 'parameters': {'gain': 'x'}}]),
    ],
)
def test_an_entry_with_a_value_of_another_type_is_refused(tmp_path: Path, content: object) -> None:
    file = tmp_path / TRIALS
    file.write_text(json.dumps([ENTRY]), encoding='utf-8')
    assert to_json(read_entries(file)) == [ENTRY]
    file.write_text(json.dumps(content), encoding='utf-8')
    with pytest.raises(DdctError) as error:
        read_entries(file)
    assert error.value.place == str(file)
    assert str(error.value).endswith('start the tuning anew')
