# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The numbers that a fit to a log looks for: parameters and delays, in the units of the fit."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.identification.from_log.stretches import LOAD, TORQUES
from ddct_bringup.logs.columns import MOST_DELAY_S
from ddct_bringup.logs.log import SPEEDS
from ddct_plant.models.parameters import DrivelineParameters

PARAMETERS = tuple(DrivelineParameters().values())
"""Names of all driveline parameters."""
DAMPINGS = ('engine_damping', 'shaft_damping')
"""Parameters that may be zero, so that their values are fitted; the others' logarithms are."""
REFERENCE = SPEEDS[0]
"""Signal whose delay is not fitted: a common delay of all signals is not identifiable."""
DELAYED = (*SPEEDS[1:], *TORQUES, LOAD)
"""Signals whose delay relative to the reference is identifiable."""
DELAY_S = 0.01
"""Unit of delays in the fit, in s."""


@dataclass(frozen=True)
class _Kind:
    """How a fit treats a kind of number, in the units of the fit."""

    prior: float
    """Standard deviation about the start: what the log does not determine stays near it."""
    bound: float
    """Largest change."""
    determined: float
    """Largest standard deviation of a determined number."""


_FACTOR = float(np.log(1000.0))
_RELATIVE = _Kind(float(np.log(10.0)), _FACTOR, 0.25)
_DAMPING = _Kind(float(np.log(10.0)), _FACTOR, 0.05)
_DELAY = _Kind(MOST_DELAY_S / DELAY_S, MOST_DELAY_S / DELAY_S, 0.5)
_PULLED = 0.4
"""Largest correction of a determined number, over its largest standard deviation."""


@dataclass(frozen=True)
class Unknowns:
    """
    The names that are fitted, and the values from which their changes x count.

    x has ln(value / start) of a parameter, the change of a damping over `damping`, and that of a
    delay over 10 ms.
    """

    names: Sequence[str]
    start: Mapping[str, float]
    """All parameters in SI units and delays in s, by name."""
    damping: float
    """Unit of dampings: the torques over the speeds of the log, in N m s/rad."""

    def values(self, x: np.ndarray) -> dict[str, float]:
        """Return all parameters and delays at x, by name, in SI units."""
        found = dict(self.start)
        for name, change in zip(self.names, x.tolist(), strict=True):
            if name in self._units:
                found[name] += change * self._units[name]
            else:
                found[name] *= float(np.exp(change))
        return found

    def deviations(self, std: np.ndarray) -> dict[str, float]:
        """Return deviations by name: in SI units of dampings and delays, of others relative."""
        pairs = zip(self.names, std.tolist(), strict=True)
        return {name: self._units.get(name, 1.0) * each for name, each in pairs}

    @property
    def prior(self) -> np.ndarray:
        """Return the prior standard deviations of x."""
        return np.array([_kind(name).prior for name in self.names])

    @property
    def bound(self) -> np.ndarray:
        """Return the largest sizes of x."""
        return np.array([_kind(name).bound for name in self.names])

    def not_determined(self, std: np.ndarray, corrected: np.ndarray) -> list[str]:
        """
        Return the names that are too uncertain, or corrected too far for a linear correction.

        If there are delays among them, only those are returned: a parameter may be uncertain only
        because a delay is.
        """
        most = np.array([_kind(name).determined for name in self.names])
        excess = np.maximum(std, np.abs(corrected) / _PULLED) > most
        weak = [name for name, each in zip(self.names, excess, strict=True) if each]
        return [name for name in weak if name in DELAYED] or weak

    @property
    def _units(self) -> dict[str, float]:
        return dict.fromkeys(DAMPINGS, self.damping) | dict.fromkeys(DELAYED, DELAY_S)


def _kind(name: str) -> _Kind:
    return _DELAY if name in DELAYED else _DAMPING if name in DAMPINGS else _RELATIVE
