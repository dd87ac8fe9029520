# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Distributions for the random keys of a campaign, by name, each with its quantile function."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

KIND, LOW, HIGH, STEP, CHOICE = 'distribution', 'low', 'high', 'step', 'choice'
VALUES = 'values'
"""Key of the values of `CHOICE`."""
Numbers = Mapping[str, float]
_DIGITS = 12
"""Decimals of a value that is rounded to a step: 0.035, not 0.035000000000000003."""


@dataclass(frozen=True)
class Distribution:
    """Distribution of one key that varies at random."""

    kind: str
    """Name of the distribution: a key of `KINDS`, or `CHOICE`."""
    numbers: Numbers
    """Parameters by name; none for a choice."""
    values: tuple[Any, ...] = ()
    """Values of a choice; empty for other kinds."""
    weights: tuple[float, ...] = ()
    """Probabilities of the values of a choice, summing to 1; empty for other kinds."""

    def value(self, uniform: float) -> Any:
        """Return the quantile of a number between 0 and 1, both excluded."""
        if self.kind == CHOICE:
            place = int(np.searchsorted(np.cumsum(self.weights), uniform, side='right'))
            return self.values[min(place, len(self.values) - 1)]
        value = float(KINDS[self.kind].quantile(self.numbers, uniform))
        low, high = self.ends
        value = min(max(value, low), high)
        if STEP not in self.numbers:
            return value
        step = self.numbers[STEP]
        rounded = round(round(value / step) * step, _DIGITS)
        return int(rounded) if self.whole else rounded

    @property
    def whole(self) -> bool:
        """Whether all values are whole numbers."""
        return float(self.numbers.get(STEP, 0.5)).is_integer()

    @property
    def ends(self) -> tuple[float, float]:
        """Smallest and largest value, infinite where there is no bound."""
        low = KINDS[self.kind].least
        return self.numbers.get(LOW, low), self.numbers.get(HIGH, math.inf)


@dataclass(frozen=True)
class Kind:
    """One named distribution of numbers."""

    quantile: Callable[[Numbers, float], float]
    required: Sequence[str]
    above_zero: Sequence[str] = ()
    """Names of the parameters that must be above zero."""
    optional: Sequence[str] = ()
    least: float = -math.inf
    """Lower end of the distribution without bounds."""


def _uniform(p: Numbers, uniform: float) -> float:
    return p[LOW] + uniform * (p[HIGH] - p[LOW])


def _loguniform(p: Numbers, uniform: float) -> float:
    return p[LOW] * (p[HIGH] / p[LOW]) ** uniform


def _triangular(p: Numbers, uniform: float) -> float:
    low, mode, high = p[LOW], p['mode'], p[HIGH]
    if uniform * (high - low) < mode - low:
        return low + math.sqrt(uniform * (high - low) * (mode - low))
    return high - math.sqrt((1.0 - uniform) * (high - low) * (high - mode))


def _normal(p: Numbers, uniform: float) -> float:
    ends = [(p.get(each, end) - p['mean']) / p['std'] for each, end in _OPEN]
    return p['mean'] + p['std'] * _standard_normal(uniform, *ends)


def _lognormal(p: Numbers, uniform: float) -> float:
    ends = [
        (math.log(p[each] / p['median']) if each in p else end) / p['sigma'] for each, end in _OPEN
    ]
    return p['median'] * math.exp(p['sigma'] * _standard_normal(uniform, *ends))


def _standard_normal(uniform: float, low: float, high: float) -> float:
    """Return the quantile of the standard normal distribution between two ends."""
    if low > 0.0:  # far above 0 the distribution function rounds to 1
        return -_standard_normal(1.0 - uniform, -high, -low)
    least, most = scipy.special.ndtr(low), scipy.special.ndtr(high)
    return float(scipy.special.ndtri(least + uniform * (most - least)))


_OPEN = ((LOW, -math.inf), (HIGH, math.inf))
KINDS: Mapping[str, Kind] = {
    'uniform': Kind(_uniform, (LOW, HIGH)),
    'loguniform': Kind(_loguniform, (LOW, HIGH), above_zero=(LOW,)),
    'triangular': Kind(_triangular, (LOW, 'mode', HIGH)),
    'normal': Kind(_normal, ('mean', 'std'), ('std',), (LOW, HIGH)),
    'lognormal': Kind(
        _lognormal, ('median', 'sigma'), ('median', 'sigma', LOW), (LOW, HIGH), least=0.0
    ),
}
