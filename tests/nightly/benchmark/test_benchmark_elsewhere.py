# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A benchmark gives the same on other kernels and with any number of workers."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from small_benchmark import (
    benchmark_of_a_controller_that_remembers,
    content_of,
    judge,
    result_in,
)

from ddct_bringup.verification.comparison import Comparison

ON_OTHER_KERNELS = """
import sys
from pathlib import Path
from pytest import MonkeyPatch
from small_benchmark import judge, use_release
patch = MonkeyPatch()
use_release(Path(sys.argv[1]), patch)
raise SystemExit(judge(Path(sys.argv[3]), sys.argv[2]))
"""


place = pytest.fixture(scope='module')(benchmark_of_a_controller_that_remembers)


def test_other_kernels_give_the_same_values_within_the_bound(place: Path, tmp_path: Path) -> None:
    program = [sys.executable, '-c', ON_OTHER_KERNELS]
    paths = [place / 'packaged', place / 'remembers.py', tmp_path / 'other']
    done = subprocess.run(
        [*program, *map(str, paths)],
        env={**os.environ, 'OPENBLAS_CORETYPE': 'Prescott', 'PYTHONPATH': ':'.join(sys.path)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    comparison = Comparison()
    comparison.add_nested('', result_in(place / 'first'), result_in(tmp_path / 'other'))
    assert comparison.beyond is None


def test_the_bytes_are_the_same_with_any_number_of_workers(place: Path, tmp_path: Path) -> None:
    for workers in ('2', '3'):
        out = tmp_path / workers
        assert judge(out, str(place / 'remembers.py'), '--workers', workers) == 0
        assert content_of(out) == content_of(place / 'first')
