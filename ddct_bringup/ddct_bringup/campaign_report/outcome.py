"""
What counts as a failed engagement, and the share of them.

    engaged   the run is valid, and the state of its verdict is `engaged`
    failed    the run is valid, and its state is any other
    invalid   the run does not count: it is neither, and is never left out

A criterion beyond its limit is no failed engagement: the verdict tells the two apart.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.verdict.state import ENGAGED, INVALID

FAILED = 'failed'
CONFIDENCE = 0.95
METHOD = 'Clopper-Pearson'


@dataclass(frozen=True)
class FailedShare:
    """How many engagements of some runs failed."""

    runs: int
    engaged: int
    failed: int
    invalid: int

    @property
    def share(self) -> float | None:
        """Failed among the valid runs, 0 to 1; None without a valid one."""
        valid = self.runs - self.invalid
        return self.failed / valid if valid else None

    def interval(self) -> tuple[float, float]:
        """
        Return the ends of the Clopper-Pearson interval of the share, for runs that are a sample.

        Nobody knows what an invalid run would have come to: the lower end takes all of them for
        engaged, the upper end for failed.
        """
        outside = (1.0 - CONFIDENCE) / 2.0
        least, most, runs = self.failed, self.failed + self.invalid, self.runs
        lower = float(scipy.special.betaincinv(least, runs - least + 1, outside)) if least else 0.0
        upper = 1.0
        if most < runs:
            upper = float(scipy.special.betaincinv(most + 1, runs - most, 1.0 - outside))
        return lower, upper


def outcomes_of(valid: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return `engaged`, `failed` or `invalid` per run; both arguments are (n,)."""
    counts = valid.astype(bool) & (states != INVALID)
    return np.where(counts, np.where(states == ENGAGED, ENGAGED, FAILED), INVALID)


def failed_share(outcomes: np.ndarray) -> FailedShare:
    """Return the counts of (n,) outcomes."""
    engaged, failed, invalid = (
        int(np.sum(outcomes == outcome)) for outcome in (ENGAGED, FAILED, INVALID)
    )
    return FailedShare(len(outcomes), engaged, failed, invalid)
