# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Capacity of the clutch beyond wear gain times actuator torque, and its interval."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.clutch import AMBIENT_C, FrictionParameters
from ddct_plant.scenario.settings import RunSettings

COOLER_K, WARMER_K = 2.0, 10.0
"""Largest fall and rise of the temperature of the facing after control start in K."""
_RESIDUAL = 1e-9
"""Difference in N m of a capacity from its law that is rounding."""


@dataclass(frozen=True, eq=False)
class CapacityRange:
    """
    Interval of capacity - K_usura C_a in N m.

    The kiss point moves with the temperature of the facing, which is the same over a period: so
    the rest is one number in [low, high] for each period. Where the capacity of a run was clipped
    at zero the rest is another one at each of the nodes of that period.
    """

    low: float
    high: float
    most: float
    """Greatest capacity in N m, infinite for a linear clutch."""
    positive: bool
    """Whether the capacity is never negative, as of a clutch that sticks."""
    clipped: Mapping[int, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)
    """Least and largest addition by clipping at the nodes, (11,) each, by period after control
    start."""

    def with_run(self, settings: RunSettings, run: Trajectory, periods: range) -> 'CapacityRange':
        """Return the interval widened so that it contains the capacities of a run."""
        rest = run.clutch_torque - settings.case.wear_gain * run.actuator_torque
        rest = rest[periods.start : periods.stop]
        held = np.ptp(rest, axis=1) <= _RESIDUAL
        low = min(self.low, rest[held].min(initial=self.low))
        high = max(self.high, rest[held].max(initial=self.high))
        if low >= self.low - _RESIDUAL and high <= self.high + _RESIDUAL:
            low, high = self.low, self.high
        beyond = rest - np.clip(rest, low, high)
        clipped = {
            k: (np.minimum(rest[k] - high, 0.0), np.maximum(rest[k] - low, 0.0))
            for k in np.flatnonzero(~held | (np.abs(beyond).max(axis=1) > _RESIDUAL)).tolist()
        }
        return replace(self, low=low, high=high, clipped=clipped)


def capacity_range(settings: RunSettings, temperature_c: float) -> CapacityRange:
    """
    Return the interval for a facing of `temperature_c` at control start, without clipping.

    Raise ParameterError where friction depends on the slip speed, or on the temperature there: the
    capacity is then no affine function of the actuator's torque.
    """
    if not settings.stick_slip:
        return CapacityRange(0.0, 0.0, np.inf, positive=False)
    friction = settings.scenario.friction
    if friction.slip_rad_s:
        raise ParameterError(
            'friction.slip_rad_s: friction depends on the slip speed: there is no floor',
            key='friction.slip_rad_s',
        )
    coolest, hottest = temperature_c - COOLER_K, temperature_c + WARMER_K
    if _fades(friction, coolest, hottest):
        raise ParameterError(
            f'friction.temperature_share: friction changes near {temperature_c:.0f} °C, the '
            'temperature of the facing at control start: there is no floor'
        )
    ends = np.array([coolest, hottest]) if friction.kiss_drift_n_m_k else np.array([AMBIENT_C])
    kiss = friction.kiss_torque_n_m - friction.kiss_drift_n_m_k * (ends - AMBIENT_C)
    rest = -settings.case.wear_gain * kiss
    return CapacityRange(rest.min(), rest.max(), friction.most_n_m, positive=True)


def stays_within(
    settings: RunSettings, run: Trajectory, start: int, end: int, temperature_c: float
) -> bool:
    """
    Return whether the facing stays within the temperatures of `capacity_range`.

    Where neither kiss point nor friction change it may be as warm as it likes.
    """
    if run.clutch_temperature is None:
        return True
    temperatures = run.clutch_temperature[start:end]
    coolest, hottest = float(temperatures.min()), float(temperatures.max())
    if coolest >= temperature_c - COOLER_K and hottest <= temperature_c + WARMER_K:
        return True
    friction = settings.scenario.friction
    return not friction.kiss_drift_n_m_k and not _fades(friction, coolest, hottest)


def _fades(friction: FrictionParameters, coolest: float, hottest: float) -> bool:
    """Return whether friction is another than that of a cold facing between two temperatures."""
    if not friction.temperature_c:
        return False
    inner = [t for t in friction.temperature_c if coolest < t < hottest]
    shares = np.interp(
        [coolest, hottest, *inner], friction.temperature_c, friction.temperature_share
    )
    return bool(np.any(shares != 1.0))
