# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Declarations of metrics and criteria."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_plant.program.table import Quantity

Metrics = Mapping[str, float | int | None]
"""Value of every metric by its key in `scores.json`; None where it is undefined."""
NO_WINDOW = 'the run ends before the score window does, or a value is not finite'
NOT_FINITE = 'a value is not finite'
NO_TIMING = 'there is no timing.json'


def _always(engagement: Engagement) -> bool:
    return True


@dataclass(frozen=True, kw_only=True)
class Computed(Quantity):
    """A quantity that is computed from an engagement."""

    value: Callable[[Engagement], Values | None]
    """Function that computes it, (R,) for many runs; None or not finite where it is undefined."""
    exists: Callable[[Engagement], bool | np.ndarray] = _always
    """
    Whether it is defined for the plant, (R,) for many runs. No limit applies where it is not.
    """
    signals: tuple[str, ...] = ()
    """
    Signals of the trajectory that some runs lack: those of another clutch, or recorded before the
    signal existed.
    """
    needs: tuple[str, ...] = ()
    """Quantities of the log of another tool without which it has no value."""

    def of(self, engagement: Engagement) -> Values | None:
        """Return the value; None for a run that lacks one of `signals`."""
        if any(getattr(engagement.trajectory, name) is None for name in self.signals):
            return None
        return self.value(engagement)


@dataclass(frozen=True, kw_only=True)
class Criterion(Computed):
    """One criterion of an engagement; its key is its name in `verdict`."""

    metric: str = ''
    """Key of the metric that is the same quantity; empty for none."""


@dataclass(frozen=True, kw_only=True)
class Metric(Computed):
    """One metric; its key is that of `metrics` in `scores.json`."""

    criterion: str = ''
    """Name of the criterion of the verdict that has its value; empty for none."""
    column: bool = False
    """Whether the tables of `score` and `compare` have a column of it."""
    smaller_is_better: bool = True
    """Whether a smaller magnitude is better. Only then campaigns summarise and compare it."""
    from_timing: bool = False
    """Whether it is computed from `timing.json`; the others are equal in every repetition."""
    of_shift: bool = False
    """Whether only a gear shift has it: tables and pages of other runs leave it out."""

    def as_criterion(self) -> Criterion:
        """Return the criterion with the value of this metric."""
        return criterion(
            self.criterion,
            self.unit,
            self.value,
            self.meaning,
            self.undefined,
            exists=self.exists,
            signals=self.signals,
            needs=self.needs,
            metric=self.key,
        )


def criterion(
    name: str,
    unit: str,
    value: Callable[[Engagement], Values | None],
    meaning: str,
    undefined: str,
    *,
    exists: Callable[[Engagement], bool | np.ndarray] = _always,
    signals: tuple[str, ...] = (),
    needs: tuple[str, ...] = (),
    metric: str = '',
) -> Criterion:
    """Return a criterion; its symbol in tables is its name in words."""
    return Criterion(
        key=name,
        symbol=name.replace('_', ' '),
        unit=unit,
        form='.4g',
        meaning=meaning,
        undefined=undefined,
        value=value,
        exists=exists,
        signals=signals,
        needs=needs,
        metric=metric,
    )


def finite(value: Values | None) -> float | int | None:
    """Return the value as a Python number, None where it is not finite."""
    if value is None or not math.isfinite(value):
        return None
    return value if isinstance(value, int) else float(value)
