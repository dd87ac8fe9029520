# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`make loaded-runs` counts a run with another hash, and leaves no busy process."""

import os
from pathlib import Path

import pytest
from soak.loaded_runs import PLANS, SAME, busy_cores, outcome
from support.runs import expected

pytestmark = pytest.mark.slow


def test_a_run_with_another_hash_is_named(tmp_path: Path) -> None:
    run = PLANS['one clutch']
    right = expected(run).sha256()
    assert outcome(run, right, tmp_path / 'right') == SAME
    assert outcome(run, '0' * 64, tmp_path / 'wrong') == f'another hash, {right[:12]}'


def test_no_busy_process_is_left() -> None:
    with busy_cores() as busy:
        assert len(busy) == os.cpu_count()
        assert all(process.poll() is None for process in busy)
    assert all(process.poll() is not None for process in busy)
