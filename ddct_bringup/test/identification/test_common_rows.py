# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Speeds in messages of their own share the rows of the engine speed."""

from pathlib import Path

import numpy as np

from ddct_bringup.identification.from_log.common_rows import in_common_rows
from ddct_bringup.logs.log import MeasuredLog

ENGINE_S, SHAFT_S = 0.01 * np.arange(50), 0.01 * np.arange(50) + 0.003
WHEEL_S = 0.02 * np.arange(25) + 0.0041


def bus_log() -> MeasuredLog:
    """Return a log of three messages, one of them every 20 ms; each sample is its time."""
    messages = {'engine_speed': ENGINE_S, 'shaft_speed': SHAFT_S, 'wheel_speed': WHEEL_S}
    times = np.unique(np.concatenate([*messages.values()]))
    signals = {
        name: np.where(np.isin(times, each), times, np.nan) for name, each in messages.items()
    }
    return MeasuredLog(Path('a.mf4'), '', times, signals)


def test_each_sample_moves_to_the_next_row_of_the_engine_and_none_is_lost() -> None:
    log = in_common_rows(bus_log())
    rows = np.isin(log.time_s, ENGINE_S)
    shaft, wheel = log.signals['shaft_speed'][rows], log.signals['wheel_speed'][rows]
    np.testing.assert_array_equal(shaft, SHAFT_S)
    np.testing.assert_array_equal(wheel[::2], WHEEL_S)
    assert np.isnan(wheel[1::2]).all()
    assert np.isnan(log.signals['shaft_speed'][~rows]).all()


def test_speeds_that_come_together_stay() -> None:
    signals = dict.fromkeys(('engine_speed', 'shaft_speed', 'wheel_speed'), ENGINE_S)
    log = MeasuredLog(Path('a.csv'), '', ENGINE_S, signals)
    assert in_common_rows(log) is log


def test_speeds_that_mostly_come_together_stay() -> None:
    """Every fourth sample of a speed is lost, as on a busy bus, each time of another one."""
    names = ('engine_speed', 'shaft_speed', 'wheel_speed')
    places = np.arange(len(ENGINE_S))
    signals = {
        name: np.where(places % 12 == 4 * lost, np.nan, ENGINE_S)
        for lost, name in enumerate(names)
    }
    log = MeasuredLog(Path('a.csv'), '', ENGINE_S, signals)
    assert in_common_rows(log) is log
