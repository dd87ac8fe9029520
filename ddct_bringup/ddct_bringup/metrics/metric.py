# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Declaration of a metric: its value, and when and why it has none."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_plant.program.table import Quantity

Metrics = Mapping[str, float | int | None]
"""Value of every metric by its key in `scores.json`; None where it is undefined."""
NO_TIMING = 'there is no timing.json'
NOT_FINITE = 'a value is not finite'


@dataclass(frozen=True)
class Null:
    """A condition under which a metric has no value."""

    reason: str
    """Reason in a few words."""
    holds: Callable[[Engagement], bool]
    """Function that returns whether it holds for one run."""


@dataclass(frozen=True, kw_only=True)
class Metric(Quantity):
    """One metric of a run; its key is that of `figures` or `metrics` in `scores.json`."""

    value: Callable[[Engagement], Values | None]
    """Function that computes it, (R,) for many runs; None or not finite where it is undefined."""
    nulls: tuple[Null, ...] = ()
    """Conditions without a value; the first that holds is the reason of a run."""
    figure: bool = False
    """Whether a run is judged by it: `figures` has it, `metrics` the others."""
    signals: tuple[str, ...] = ()
    """
    Signals of the trajectory that some runs lack: those of another clutch, or recorded before the
    signal existed.
    """
    needs: tuple[str, ...] = ()
    """Quantities of the log of another tool without which it has no value."""
    smaller_is_better: bool = True
    """Whether a smaller magnitude is better. Only then campaigns summarise and compare it."""
    from_timing: bool = False
    """Whether it is computed from `timing.json`; the others are equal in every repetition."""
    of_shift: bool = False
    """Whether only a gear shift has it: tables and pages of other runs leave it out."""

    def __post_init__(self) -> None:
        """Set the text of all conditions."""
        if self.nulls and not self.undefined:
            object.__setattr__(self, 'undefined', ', or '.join(each.reason for each in self.nulls))

    def of(self, engagement: Engagement) -> Values | None:
        """Return the value; None for a run that lacks one of `signals`."""
        if any(getattr(engagement.trajectory, name) is None for name in self.signals):
            return None
        return self.value(engagement)

    def why_null(self, engagement: Engagement) -> str:
        """Return the reason why one run has no value."""
        return next((each.reason for each in self.nulls if each.holds(engagement)), NOT_FINITE)


def finite(value: Values | None) -> float | int | None:
    """Return the value as a Python number, None where it is not finite."""
    plain = value.item() if isinstance(value, (np.ndarray, np.generic)) else value
    return plain if plain is not None and math.isfinite(plain) else None
