# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results of a verification: the state of each repeated run or file, with its first difference."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ddct_bringup.verification.comparison import Comparison
from ddct_bringup.verification.states import DIFFERENT, NOT_REPEATED


@dataclass(frozen=True)
class RepetitionResult:
    """State of one run, table, document or page."""

    run: str
    """Name of the bag, or path of the file."""
    state: str
    first_difference: Mapping[str, Any] | None = None
    """Place of the first difference with both values, or its `reason`; None in another state."""
    largest_difference: float | None = 0.0
    """Largest difference, relative as `BOUND`; 0 for equal bits, None where it is infinite."""
    note: str = ''
    """Reason why it was not repeated, or what else to know of it."""

    @classmethod
    def of(
        cls, run: str, comparison: Comparison, *, same_environment: bool, note: str = ''
    ) -> 'RepetitionResult':
        """Return the result of a comparison."""
        first = comparison.first(same_environment=same_environment)
        state = comparison.state(same_environment=same_environment)
        largest = comparison.largest if math.isfinite(comparison.largest) else None
        return cls(run, state, first.entry() if first else None, largest, note)

    @classmethod
    def failed(cls, run: str, reason: object, note: str = '') -> 'RepetitionResult':
        """Return the result of a run that could not be repeated, though it should be."""
        return cls(run, DIFFERENT, {'reason': str(reason)}, note=note)

    @classmethod
    def not_repeated(cls, run: str, note: str) -> 'RepetitionResult':
        """Return the result of what was not made again, or not compared."""
        return cls(run, NOT_REPEATED, note=note)
