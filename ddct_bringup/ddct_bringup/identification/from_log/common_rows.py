# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Speeds that come in messages of their own, as on a bus, in the rows of one of them."""

from dataclasses import replace

import numpy as np

from ddct_bringup.logs.log import SPEEDS, MeasuredLog

_SHARE = 0.5
"""Share of the samples of the rarest speed that are in rows with all three, if all come so."""


def in_common_rows(log: MeasuredLog) -> MeasuredLog:
    """
    Return a log whose rows of the engine speed have the other two, where few rows have all three.

    A sample moves to the row next to it, by at most half a step of its own. Messages of equal
    periods so get a constant delay, which a fit finds. A log whose speeds come together stays.
    """
    finite = {name: np.isfinite(log.signals[name]) for name in SPEEDS}
    fewest = min(int(each.sum()) for each in finite.values())
    if np.logical_and.reduce([*finite.values()]).sum() >= _SHARE * fewest or fewest < 2:
        return log
    base, *others = SPEEDS
    rows = np.flatnonzero(finite[base])
    signals = dict(log.signals)
    for name in others:
        signals[name] = _moved(log, name, rows)
    return replace(log, signals=signals)


def _moved(log: MeasuredLog, name: str, rows: np.ndarray) -> np.ndarray:
    """Return a signal whose samples are in the nearest of some rows, NaN in all others."""
    times, values = log.samples(name)
    at = log.time_s[rows]
    after = np.clip(np.searchsorted(times, at), 1, len(times) - 1)
    nearest = after - (at - times[after - 1] < times[after] - at)
    near = np.abs(times[nearest] - at) <= 0.5 * log.usual_step(name)
    # Of two rows within half a step of a sample, as of a slower signal, the nearer has it.
    apart = np.abs(times[nearest] - at)
    best = np.full(len(times), np.inf)
    np.minimum.at(best, nearest, apart)
    taken = near & (apart == best[nearest])
    moved = np.full(len(log.time_s), np.nan)
    moved[rows[taken]] = values[nearest[taken]]
    return moved
