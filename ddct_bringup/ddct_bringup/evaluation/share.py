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
from functools import cache

import numpy as np

from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.program.table import UNDEFINED

FAILED = 'failed'
CONFIDENCE = 0.95
METHOD = 'Clopper-Pearson'


def outcomes_of(valid: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return `engaged`, `failed` or `invalid` per run; both arguments are (n,)."""
    counts = valid.astype(bool) & (states != INVALID)
    return np.where(counts, np.where(states == ENGAGED, ENGAGED, FAILED), INVALID)


@dataclass(frozen=True)
class Share:
    """Number of some runs among others."""

    count: int
    of: int
    low: float | None = None
    """Lower end of the interval of the share, 0 to 1; None for runs that are no sample."""
    high: float | None = None
    """Upper end of the interval."""

    @classmethod
    def in_sample(cls, count: int, of: int, in_doubt: int = 0) -> 'Share':
        """
        Return a share of a random sample of runs, with its Clopper-Pearson interval.

        Of further runs, `in_doubt`, it is not known whether they count: at the lower end none
        does, at the upper end each.
        """
        return cls(count, of, *_interval(count, of, in_doubt)) if of + in_doubt else cls(0, 0)

    @property
    def value(self) -> float | None:
        """Share, 0 to 1; None of no runs."""
        return self.count / self.of if self.of else None

    @property
    def text(self) -> str:
        """Share in percent, or a dash."""
        return share_text(self.value)

    @property
    def interval_text(self) -> str:
        """Ends of the interval in percent, or a dash."""
        if self.low is None or self.high is None:
            return UNDEFINED
        return f'{100.0 * self.low:.1f} to {100.0 * self.high:.1f} %'


def share_text(value: float | None) -> str:
    """Return a number from 0 to 1 in percent, or a dash."""
    return UNDEFINED if value is None else f'{100.0 * value:.1f} %'


@cache
def _interval(count: int, of: int, in_doubt: int) -> tuple[float, float]:
    # Those of scipy.stats.beta, whose import takes half a second.
    from scipy.special import betaincinv

    outside = (1.0 - CONFIDENCE) / 2.0
    most, runs = count + in_doubt, of + in_doubt
    low = float(betaincinv(count, runs - count + 1, outside)) if count else 0.0
    high = float(betaincinv(most + 1, runs - most, 1.0 - outside)) if most < runs else 1.0
    return low, high
