# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Simulated drives of several kinds, and how often intervals hold the true values."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.logs.log import MeasuredLog
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.file import load_scenario
from support.logs import NONE_LATE, drag, late_fit, noisy_log_of, within
from support.other_car import TRUE, late_log

BEFORE = {
    'corners on rows': (1519 / 1600, 784 / 800),
    'corners between rows': (1509 / 1600, 765 / 800),
    'late signal': (1499 / 1600, 768 / 800),
}
"""
Rates at which the intervals of parameters and of delays held the true values before, by kind.

They are those of commit 65ba0ca0 in 200 drives of each kind.
"""


@dataclass(frozen=True)
class Coverage:
    """Numbers of intervals that hold the true value, and of all."""

    parameters: tuple[int, int]
    delays: tuple[int, int]


def coverage(kind: str, seeds: Iterable[int], pi_log: MeasuredLog) -> Coverage:
    """Return the coverage of fits to drives of one kind; `pi_log` is a run of `thesis`."""
    held = [_held(kind, seed, pi_log) for seed in seeds]
    parameters, delays = (
        [hit for fit in held for name, hit in fit.items() if (name in TRUE) == of_car]
        for of_car in (True, False)
    )
    return Coverage((sum(parameters), len(parameters)), (sum(delays), len(delays)))


def _held(kind: str, seed: int, pi_log: MeasuredLog) -> dict[str, bool]:
    """Return by parameter and delay whether its interval holds the true value."""
    if kind == 'late signal':
        thesis = load_scenario('thesis')
        true = thesis.driveline.values() | NONE_LATE | {'clutch_torque': 0.01}
        fit = late_fit(pi_log, seed, ('clutch_torque',), 1)
    else:
        random = np.random.default_rng(seed)
        late = dict(zip(NONE_LATE, random.uniform(-0.05, 0.05, 4).tolist(), strict=True))
        true = TRUE | late
        times, signals = late_log(seed, late, corners_on_rows=kind == 'corners on rows')
        start = DrivelineParameters.from_values(TRUE)
        fit = fit_log(noisy_log_of(times, signals, seed), start, drag)
    return dict(zip(true, within(fit, true), strict=True))
