# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The work for a log with many gaps grows with its rows, and not with rows times gaps."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ddct_bringup.identification.from_log import response
from ddct_bringup.identification.from_log.problem import LogProblem
from ddct_bringup.identification.from_log.stretches import FEWEST_SAMPLES, stretches_of
from ddct_bringup.identification.from_log.unknowns import Unknowns
from ddct_bringup.logs.log import MeasuredLog
from ddct_plant.models.parameters import DrivelineParameters

ROWS = 60
"""Rows of each stretch."""


def no_load(speed: np.ndarray) -> np.ndarray:
    return np.zeros_like(speed)


def log_of(gaps: int) -> MeasuredLog:
    """Return a log of 10 ms steps with a gap of ten steps after every 60 rows."""
    rows = np.arange(ROWS * (gaps + 1))
    time_s = 0.01 * (rows + 10 * (rows // ROWS))
    random = np.random.default_rng(1)
    names = ('engine_speed', 'shaft_speed', 'wheel_speed', 'engine_torque', 'clutch_torque')
    signals = {name: 100.0 + random.standard_normal(len(rows)) for name in names}
    return MeasuredLog(Path('a.csv'), '', time_s, signals)


def test_each_gap_of_any_signal_ends_a_stretch() -> None:
    log = log_of(2)
    time_s = log.time_s
    log.signals['clutch_torque'][ROWS + 5 : ROWS + 15] = np.nan  # 45 rows are left after it
    log.signals['engine_torque'][-7:] = np.nan
    found = stretches_of(log, no_load)
    ends = [(each.time_s[0], each.time_s[-1]) for each in found]
    firsts, lasts = (0, ROWS + 15, 2 * ROWS), (ROWS - 1, 2 * ROWS - 1, 3 * ROWS - 8)
    expected = [(time_s[a], time_s[b]) for a, b in zip(firsts, lasts, strict=True)]
    assert np.allclose(ends, expected, rtol=0.0, atol=1e-9)
    assert all(len(each.time_s) >= FEWEST_SAMPLES for each in found)


def test_the_whole_log_is_searched_as_often_with_many_gaps_as_with_few(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    searched = []
    isfinite: Any = np.isfinite
    for gaps in (3, 30):
        log = log_of(gaps)
        whole: list[bool] = []

        def counted(values: np.ndarray, *, log=log, whole=whole) -> np.ndarray:
            whole.append(len(values) == len(log.time_s))
            return isfinite(values)

        monkeypatch.setattr(np, 'isfinite', counted)
        assert len(stretches_of(log, no_load)) == gaps + 1
        searched.append(sum(whole))
    assert searched[0] == searched[1] > 0


def test_the_modes_of_the_driveline_are_computed_once_for_all_stretches(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stretches = stretches_of(log_of(4), no_load)
    evaluations: list[int] = []
    computed: list[DrivelineParameters] = []
    matrices = response.driveline_matrices

    def counted(parameters: DrivelineParameters) -> Any:
        computed.append(parameters)
        return matrices(parameters)

    monkeypatch.setattr(response, 'driveline_matrices', counted)
    unknowns = Unknowns(['engine_inertia'], DrivelineParameters().values(), 1.0)
    problem: Any = LogProblem(unknowns, stretches, lambda: evaluations.append(1))
    for change in (0.0, 0.1):
        problem._residuals(np.array([change]), stretches)
    assert (len(evaluations), len(computed)) == (2, 2)
