# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The record of `make soak` keeps the conditions that were not measured again."""

import json
from pathlib import Path

from soak.__main__ import renewed

MACHINE = {'processor': 'X', 'cores': 2}
BEFORE = {
    'machine': MACHINE,
    'measured': [{'condition': 'idle', 'time': 'old'}, {'condition': 'busy', 'time': 'old'}],
}
NEW = [{'condition': 'busy', 'time': 'new'}]


def test_a_condition_is_replaced_and_others_stay(tmp_path: Path) -> None:
    file = tmp_path / 'record.json'
    file.write_text(json.dumps(BEFORE), encoding='utf-8')
    measured = renewed(file, MACHINE, NEW)['measured']
    assert measured == [{'condition': 'idle', 'time': 'old'}, *NEW]


def test_conditions_of_another_machine_go(tmp_path: Path) -> None:
    file = tmp_path / 'record.json'
    file.write_text(json.dumps(BEFORE), encoding='utf-8')
    other = {**MACHINE, 'cores': 4}
    assert renewed(file, other, NEW) == {'machine': other, 'measured': NEW}


def test_a_first_record_has_what_was_measured(tmp_path: Path) -> None:
    assert renewed(tmp_path / 'new.json', MACHINE, NEW)['measured'] == NEW
