"""
What runs came to, and the shares of it with their intervals.

    engaged   the run is valid, and the state of its verdict is `engaged`
    failed    the run is valid, and its state is none of `SUCCESSES`
    invalid   the run does not count: it is neither, and is never left out

Another state of `SUCCESSES` is an outcome of its own: it is no failure, and not engaged. A
criterion beyond its limit is no failed engagement: the verdict tells the two apart.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.verdict.state import ENGAGED, INVALID, SUCCESSES

FAILED = 'failed'
CONFIDENCE = 0.95
METHOD = 'Clopper-Pearson'


def outcomes_of(valid: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return a state of `SUCCESSES`, `failed` or `invalid` per run; both arguments are (n,)."""
    counts = valid.astype(bool) & (states != INVALID)
    return np.where(counts, np.where(np.isin(states, SUCCESSES), states, FAILED), INVALID)


@dataclass(frozen=True)
class Share:
    """How many of some runs are of one kind."""

    count: int
    invalid: int
    runs: int

    @property
    def share(self) -> float | None:
        """Those of the kind among the valid runs, 0 to 1; None without a valid one."""
        valid = self.runs - self.invalid
        return self.count / valid if valid else None

    def interval(self) -> tuple[float, float]:
        """
        Return the ends of the Clopper-Pearson interval of the share, for runs that are a sample.

        Nobody knows what an invalid run would have come to: at the lower end none is of this kind,
        at the upper end each is.
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
    """How many runs came to what."""

    runs: int
    engaged: int
    failed: int
    invalid: int

    @property
    def failed_share(self) -> Share:
        """The share of failed engagements."""
        return Share(self.failed, self.invalid, self.runs)


def count_outcomes(outcomes: np.ndarray) -> Outcomes:
    """Return the counts of (n,) outcomes."""
    engaged, failed, invalid = (
        int(np.sum(outcomes == outcome)) for outcome in (ENGAGED, FAILED, INVALID)
    )
    return Outcomes(len(outcomes), engaged, failed, invalid)
