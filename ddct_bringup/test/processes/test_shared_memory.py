# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Only requested segments without a live owner are removed."""

import fcntl
import os

import pytest

from ddct_bringup.processes import shared_memory
from ddct_bringup.processes.shared_memory import remove_segments, segments_of


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(shared_memory, 'SHARED_MEMORY', tmp_path)
    for segment in ('fastrtps_1', 'fastrtps_port7', 'fastrtps_other'):
        for file in (segment, f'{segment}_el', f'sem.{segment}_mutex'):
            (tmp_path / file).touch()
    return tmp_path


def left(folder):
    return sorted(file.name for file in folder.iterdir())


def test_the_segments_of_a_process_are_those_that_it_has_locked(folder):
    with (folder / 'fastrtps_1_el').open(), (folder / 'fastrtps_port7').open():
        assert segments_of(os.getpid()) == {'fastrtps_1'}


def test_a_process_that_has_ended_has_no_segments():
    assert segments_of(2**22) == set()


def test_the_segments_of_a_dead_owner_are_removed_and_no_others(folder):
    remove_segments(['fastrtps_1', 'fastrtps_port7', 'fastrtps_gone'])
    assert left(folder) == ['fastrtps_other', 'fastrtps_other_el', 'sem.fastrtps_other_mutex']


def test_a_segment_that_a_live_process_has_taken_over_stays(folder):
    with (folder / 'fastrtps_port7_el').open() as owned:
        fcntl.flock(owned, fcntl.LOCK_EX)
        remove_segments(['fastrtps_port7'])
    assert {'fastrtps_port7', 'fastrtps_port7_el', 'sem.fastrtps_port7_mutex'} < set(left(folder))
