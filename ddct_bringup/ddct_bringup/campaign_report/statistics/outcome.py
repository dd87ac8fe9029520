# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Outcomes of runs, and their shares with confidence intervals.

    engaged   the run is valid, and its state is `engaged`
    failed    the run is valid, and its state is another
    invalid   the run does not count as engaged or failed, but is always listed

A metric beyond its limit is no failed engagement.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.verdict.state import ENGAGED, INVALID

FAILED = 'failed'
CONFIDENCE = 0.95
METHOD = 'Clopper-Pearson'


def outcomes_of(valid: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return `engaged`, `failed` or `invalid` per run; both arguments are (n,)."""
    counts = valid.astype(bool) & (states != INVALID)
    return np.where(counts, np.where(states == ENGAGED, ENGAGED, FAILED), INVALID)


@dataclass(frozen=True)
class Share:
    """Number of runs of one outcome among all runs."""

    count: int
    invalid: int
    runs: int

    @property
    def share(self) -> float | None:
        """Share of this outcome among the valid runs, 0 to 1; None without a valid one."""
        valid = self.runs - self.invalid
        return self.count / valid if valid else None

    def interval(self) -> tuple[float, float]:
        """
        Return the ends of the Clopper-Pearson interval of the share, for a random sample of runs.

        The outcome of an invalid run is unknown: at the lower end none has this outcome, at the
        upper end each has it.
        """
        outside = (1.0 - CONFIDENCE) / 2.0
        least, most, runs = self.count, self.count + self.invalid, self.runs
        lower = float(scipy.special.betaincinv(least, runs - least + 1, outside)) if least else 0.0
        upper = 1.0
        if most < runs:
            upper = float(scipy.special.betaincinv(most + 1, runs - most, 1.0 - outside))
        return lower, upper


@dataclass(frozen=True)
class Outcomes:
    """Number of runs of each outcome."""

    runs: int
    engaged: int
    failed: int
    invalid: int

    @property
    def failed_share(self) -> Share:
        """Share of failed engagements."""
        return Share(self.failed, self.invalid, self.runs)


def count_outcomes(outcomes: np.ndarray) -> Outcomes:
    """Return the counts of (n,) outcomes."""
    engaged, failed, invalid = (
        int(np.sum(outcomes == outcome)) for outcome in (ENGAGED, FAILED, INVALID)
    )
    return Outcomes(len(outcomes), engaged, failed, invalid)
