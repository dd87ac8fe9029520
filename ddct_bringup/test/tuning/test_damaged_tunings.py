# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A manifest or an entry of a trial with a value of another type is refused, with its file."""

import json
from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.tuning.manifest import MANIFEST, TuningManifest
from ddct_bringup.tuning.record import TRIALS, read_entries
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import to_json

CONTROLLER = {'name': 'pi', 'chosen': 'pi', 'folder': '.', 'digests': {'ddct': 'a'}}
CONTENT: dict[str, Any] = {
    'schema_version': 1,
    **{'version': '1', 'code_digest': 'a', 'optuna': '4', 'campaign_digest': 'b', 'folder': '.'},
    **{'limits': {'name': 'x'}, 'controller': CONTROLLER, 'spec': {}},
}
ENTRY: dict[str, Any] = {
    **{'number': 0, 'state': 'feasible', 'reason': '', 'runs': 1},
    **{'parameters': {'gain': 0.1}, 'further': {'corner': 1.5, 'other': None}},
    **{'objectives': {}, 'constraints': {}},
}


@pytest.mark.parametrize(
    'changes',
    [
        *({'version': 1}, {'folder': None}, {'limits': []}, {'spec': 'x'}, {'controller': 'pi'}),
        {'controller': {**CONTROLLER, 'folder': 1}},
        {'controller': {**CONTROLLER, 'digests': ['a']}},
        {'controller': {'name': 'pi', 'chosen': 'pi', 'folder': '.'}},
    ],
)
def test_a_manifest_with_a_value_of_another_type_is_refused(
    tmp_path: Path, changes: dict[str, Any]
) -> None:
    file = tmp_path / MANIFEST
    file.write_text(json.dumps(CONTENT), encoding='utf-8')
    assert TuningManifest.read(tmp_path).controller == CONTROLLER
    file.write_text(json.dumps({**CONTENT, **changes}), encoding='utf-8')
    with pytest.raises(DdctError) as error:
        TuningManifest.read(tmp_path)
    assert error.value.place == str(file)


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
