# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The note in a failed run's folder marks the run as failed, whatever its content."""

import json
from pathlib import Path

import pytest

from ddct_bringup.run.description import custom_data
from ddct_bringup.run.timing_and_failure import NOTE_FILE, failed_run, note_failure
from ddct_bringup.scores.bags import find_bags
from ddct_bringup.scores.scoring import unreadable_run
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')), CaseSettings(wear_gain=0.7))
FACTS = custom_data(SETTINGS, 'ls8', 300)


def test_a_note_is_read_back_with_the_reason_and_the_planned_facts(tmp_path: Path) -> None:
    note_failure(tmp_path, 'node clutch was killed', FACTS)
    found = failed_run(tmp_path)
    assert found is not None
    assert found.reason == 'node clutch was killed'
    assert found.facts is not None
    assert (found.facts.controller, found.facts.wear_gain, found.facts.steps) == ('ls8', 0.7, 300)
    assert found.custom_data == FACTS


def test_without_a_note_no_run_has_failed(tmp_path: Path) -> None:
    assert failed_run(tmp_path) is None


@pytest.mark.parametrize(
    'text',
    ['', '{', '[]', '7', '{}', '{"reason": "x"}', '{"reason": 3, "run": 4}', '{"run": {}}', '\0'],
)
def test_a_note_that_cannot_be_read_still_marks_the_run_as_failed(
    tmp_path: Path, text: str
) -> None:
    (tmp_path / NOTE_FILE).write_text(text, encoding='utf-8')
    found = failed_run(tmp_path)
    assert found is not None
    assert NOTE_FILE in found.reason
    assert found.facts is None


def test_a_run_with_a_value_that_is_no_text_cannot_be_read(tmp_path: Path) -> None:
    content = {'reason': 'failed', 'run': {**FACTS, 'settings': 5}}
    (tmp_path / NOTE_FILE).write_text(json.dumps(content), encoding='utf-8')
    found = failed_run(tmp_path)
    assert found is not None
    assert found.facts is None


def test_a_reason_cannot_reach_the_terminal_as_a_command(tmp_path: Path) -> None:
    note_failure(tmp_path, 'red\x1b[31m\nsecond line', FACTS)
    found = failed_run(tmp_path)
    assert found is not None
    assert found.reason == r'red\x1b[31m\nsecond line'


def test_the_folder_of_a_failed_run_is_found_with_or_without_a_bag(tmp_path: Path) -> None:
    for name in ('a', 'b', 'c', '.hidden'):
        (tmp_path / name).mkdir()
    for name in ('a', 'b', '.hidden'):
        note_failure(tmp_path / name, 'failed', FACTS)
    for name in ('b', 'c'):
        (tmp_path / name / 'x.mcap').write_bytes(b'')
    assert find_bags(tmp_path) == [tmp_path / 'a', tmp_path / 'b', tmp_path / 'c']
    assert find_bags(tmp_path / 'a') == [tmp_path / 'a']


def test_a_failed_run_is_recognised_by_its_note_and_not_by_its_missing_bag(tmp_path: Path) -> None:
    note_failure(tmp_path, 'node clutch was killed', FACTS)
    run = unreadable_run(tmp_path, DdctError('no .mcap file'))
    assert (run.valid, run.reason) == (False, 'node clutch was killed')
    assert (run.controller, run.facts.wear_gain) == ('ls8', 0.7)
    assert set(run.metrics.values()) == {None}
