# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results of a verification: the state of each repeated run, with its first difference."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ddct_bringup.verification.comparison import (
    BOUND,
    DIFFERENT,
    DIGEST_ONLY,
    Comparison,
)


@dataclass(frozen=True)
class RepetitionResult:
    """State of one run, or of one file with values that follow from the runs."""

    run: str
    """Name of the bag, of the file, or of the rows of a controller."""
    state: str
    first_difference: Mapping[str, Any] | None = None
    """Place of the first difference with both values, or its `reason`; None in another state."""
    largest: float = 0.0
    """Largest difference, relative as `BOUND`; 0 for equal bits."""
    note: str = ''
    """Reason why it was not repeated, or what else to know of it."""
    bound: float = BOUND
    """Bound that was used where bits may differ: BOUND, or that of a run which amplifies them."""

    @classmethod
    def of(cls, run: str, comparison: Comparison, *, same_environment: bool) -> 'RepetitionResult':
        """Return the result of a comparison."""
        first = comparison.first(same_environment=same_environment)
        state = comparison.state(same_environment=same_environment)
        entry = first.entry() if first else None
        return cls(run, state, entry, comparison.largest, bound=comparison.used)

    @classmethod
    def failed(cls, run: str, reason: object) -> 'RepetitionResult':
        """Return the result of a run that could not be repeated, though it should be."""
        return cls(run, DIFFERENT, {'reason': str(reason)})

    @classmethod
    def by_digest(cls, run: str, note: str) -> 'RepetitionResult':
        """Return the result of a run of which only digests and scores can be checked."""
        return cls(run, DIGEST_ONLY, note=note)

    def entry(self) -> Mapping[str, Any]:
        """Return the result as JSON; a largest difference that is infinite is None."""
        largest = self.largest if math.isfinite(self.largest) else None
        return {
            'run': self.run,
            'state': self.state,
            'first_difference': self.first_difference,
            'largest_difference': largest,
            'note': self.note,
            'bound': self.bound,
        }

    @property
    def same(self) -> bool:
        """Whether all that can be compared is the same."""
        return self.state != DIFFERENT
