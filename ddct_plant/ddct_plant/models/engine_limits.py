# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An engine with limits: torque over speed, idle control, rev limiter, stall and over-speed."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import ASSUMED, OptionGroup, option
from ddct_plant.base.timebase import PERIOD_S

STALLED, OVER_REVVED = 'stalled', 'over_revved'
"""Causes of an end of the run by the engine."""
_RISING_SPEEDS = ('stall_rad_s', 'idle_rad_s', 'resume_rad_s', 'cut_rad_s', 'over_rev_rad_s')


_idle = partial(option, source=ASSUMED, at_least=0.0, at_most=1e4)
_speed = partial(option, unit='rad/s', source=ASSUMED, above=0.0, at_most=2e3)
_torques = partial(option, unit='N m', many=True, at_least=0.0, at_most=1e4)


@dataclass(frozen=True)
class EngineLimits(OptionGroup, prefix='engine_limits.'):
    """
    Limits of an engine: by default those of a 1.4-litre turbocharged petrol engine.

    250 N m at 2500 rpm and 170 hp (125 kW, so 217 N m) at 5500 rpm are those of the Fiat 1.4
    MultiAir in the Alfa Romeo MiTo with the C635 gearbox (types-cars.com, 2010; 250 N m also
    easier.com, 2010). The rest of the curve is assumed. Friction is (0.97 + 0.15 n + 0.05 n^2) bar
    with n in 1000 rpm, the mean effective pressure of friction and gas exchange after Heywood
    (Internal Combustion Engine Fundamentals, 1988, chapter 13), times 1.368 l / 4 pi.
    """

    speed_rad_s: tuple[float, ...] = option(
        (0.0, 104.72, 157.08, 209.44, 261.8, 575.96, 680.68, 837.76),
        'engine speeds of both curves, from the stall speed or below to the over-rev speed or '
        'above: 0, 1000, 1500, 2000, 2500, 5500, 6500, 8000 rpm',
        'rad/s',
        source=ASSUMED,
        many=True,
        rising=True,
    )
    full_load_n_m: tuple[float, ...] = _torques(
        (0.0, 110.0, 170.0, 225.0, 250.0, 217.0, 165.0, 0.0),
        'highest torque at the crankshaft',
        source='250 and 217 N m: Fiat 1.4 MultiAir 170 hp (types-cars.com, 2010); the others '
        'assumed',
    )
    friction_n_m: tuple[float, ...] = _torques(
        (10.6, 12.7, 14.2, 16.0, 18.0, 36.0, 44.2, 58.5),
        'torque that the engine absorbs with the fuel cut',
        source='Heywood 1988, chapter 13, times 1.368 l / 4 pi',
    )
    idle_rad_s: float = _speed(94.25, 'speed that idle control keeps, 900 rpm')
    idle_gain_n_m_s: float = _idle(3.0, 'proportional gain of idle control', 'N m s/rad')
    idle_integral_n_m: float = _idle(6.0, 'integral gain of idle control', 'N m/rad')
    idle_most_n_m: float = _idle(60.0, 'highest torque of idle control', 'N m')
    stall_rad_s: float = _speed(52.36, 'speed at and below which the engine stops, 500 rpm')
    cut_rad_s: float = _speed(680.68, 'speed from which the rev limiter cuts the fuel, 6500 rpm')
    resume_rad_s: float = _speed(670.21, 'speed below which fuel comes back, 6400 rpm')
    over_rev_rad_s: float = _speed(785.4, 'speed from which the run ends, 7500 rpm')

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        super().__post_init__()
        self.require_pairs('speed_rad_s', 'full_load_n_m')
        self.require_pairs('speed_rad_s', 'friction_n_m')
        for lower, higher in zip(_RISING_SPEEDS, _RISING_SPEEDS[1:], strict=False):
            if getattr(self, lower) >= getattr(self, higher):
                raise ParameterError(
                    f'engine_limits.{lower} is {getattr(self, lower):g} rad/s: it must be below '
                    f'{higher}, {getattr(self, higher):g} rad/s',
                    key=f'engine_limits.{lower}',
                )
        speeds = self.speed_rad_s
        if not speeds or speeds[0] > self.stall_rad_s or speeds[-1] < self.over_rev_rad_s:
            given = f'goes from {speeds[0]:g} to {speeds[-1]:g} rad/s' if speeds else 'is empty'
            raise ParameterError(
                f'engine_limits.speed_rad_s {given}: the torque curves must cover the speeds from '
                f'stall_rad_s, {self.stall_rad_s:g}, to over_rev_rad_s, {self.over_rev_rad_s:g}: '
                'extend the curves, or give cut_rad_s, resume_rad_s and over_rev_rad_s of this '
                'engine (those left out are of the base car)',
                key='engine_limits.speed_rad_s',
            )

    @property
    def most_torque(self) -> float:
        """Largest torque in N m at full load, at any speed."""
        return max(self.full_load_n_m)

    def end_cause(self, speed: float) -> str | None:
        """Return the cause of an end of the run at the engine speed in rad/s, None without one."""
        if speed <= self.stall_rad_s:
            return STALLED
        return OVER_REVVED if speed >= self.over_rev_rad_s else None

    def cuts_fuel(self, speed: float, cut: bool) -> bool:
        """Return whether the rev limiter cuts the fuel at w_m in rad/s; `cut`: it did before."""
        return speed >= (self.resume_rad_s if cut else self.cut_rad_s)


def fuel_is_cut(limits: EngineLimits, speeds: np.ndarray) -> np.ndarray:
    """Return at which steps the rev limiter cuts the fuel, (n,), for w_m in rad/s from t_0 on."""
    cut, cuts = False, np.zeros(len(speeds), dtype=bool)
    for k, speed in enumerate(speeds.tolist()):
        cuts[k] = cut = limits.cuts_fuel(speed, cut)
    return cuts


class LimitedEngine:
    """
    Engine torque within the limits at the speed of t_k; called once per period.

    C_m = max(request, idle), not above the full-load torque, and not below minus the friction
    torque; minus the friction torque while the rev limiter cuts the fuel. Idle control is
    proportional and integral, K_p (w_idle - w_m) + I up to its highest torque; above idle it turns
    negative and has no effect on the request. I, a torque in N m, stays within 0 and the
    highest torque. An engine that has stalled gives no torque and never starts again.
    """

    def __init__(self, limits: EngineLimits) -> None:
        """Start with the fuel on and no integral of idle control."""
        self._limits = limits
        # Arrays: numpy would convert the lists at every step.
        self._speeds = np.array(limits.speed_rad_s)
        self._friction, self._full_load = (
            np.array(curve) for curve in (limits.friction_n_m, limits.full_load_n_m)
        )
        self._integral = 0.0
        self._cut = False
        self.end_cause: str | None = None
        """STALLED or OVER_REVVED once the run must end, None before."""

    def deliver(self, request: float, speed: float) -> float:
        """Return C_m in N m over the coming period, for `request` in N m at w_m in rad/s."""
        limits = self._limits
        if self.end_cause is None:
            self.end_cause = limits.end_cause(speed)
        if self.end_cause == STALLED:
            return 0.0
        friction = float(np.interp(speed, self._speeds, self._friction))
        self._cut = limits.cuts_fuel(speed, self._cut)
        if self._cut:
            return -friction
        most = float(np.interp(speed, self._speeds, self._full_load))
        return min(max(request, self._idle(speed), -friction), most)

    def _idle(self, speed: float) -> float:
        """Return the torque of idle control in N m, and integrate the speed error."""
        limits, missing = self._limits, self._limits.idle_rad_s - speed
        proportional = limits.idle_gain_n_m_s * missing
        torque = min(proportional + self._integral, limits.idle_most_n_m)
        integral = self._integral + limits.idle_integral_n_m * missing * PERIOD_S
        self._integral = min(max(integral, 0.0), limits.idle_most_n_m)
        return torque
