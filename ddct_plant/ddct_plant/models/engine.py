# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engine: a torque that follows the driver's demand or, within limits, a controller's request."""

import math
from dataclasses import dataclass, replace

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import REQUIRED, OptionGroup, option
from ddct_plant.base.profile import Profile
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.models.engine_limits import EngineLimits, LimitedEngine

MOST_AUTHORITY = 1e6
"""Largest allowed deviation in N m and rate in N m/s of an engine's authority."""


@dataclass(frozen=True)
class TorqueProfile(Profile, prefix='engine.'):
    """
    The driver's demand over scenario time, linear between its points and constant outside them.

    It is given in N m, or as a share of the largest torque of the engine at full load, so that
    one profile fits engines of any size.
    """

    time_s: tuple[float, ...] = option(
        REQUIRED, 'scenario times of the points', 's', many=True, rising=True
    )
    torque_n_m: tuple[float, ...] = option(
        (),
        'engine torque C_m at those times, linear between them',
        'N m',
        otherwise='one of the two',
        many=True,
        at_least=0.0,
        at_most=1e4,
        left_out=True,
    )
    torque_share: tuple[float, ...] = option(
        (),
        'engine torque then as a share of the largest of `engine_limits.full_load_n_m`, in place '
        'of `engine.torque_n_m`, so that a drive fits other engines',
        otherwise='one of the two',
        many=True,
        at_least=0.0,
        at_most=1.0,
        left_out=True,
    )

    def __post_init__(self) -> None:
        """Check the points; raise ParameterError that names the first bad one."""
        if self.torque_n_m and self.torque_share:
            raise ParameterError(
                'engine has torque_n_m and torque_share: give one of them', key='engine'
            )
        super().__post_init__()
        if not self.time_s:
            raise ParameterError(
                'engine.time_s is empty: give at least one point', key='engine.time_s'
            )

    def in_n_m(self, limits: EngineLimits | None) -> 'TorqueProfile':
        """Return the profile in N m; raise ParameterError for a share of an unknown engine."""
        if not self.torque_share:
            return self
        if limits is None:
            raise ParameterError(
                'engine.torque_share needs an engine with a full-load torque: give engine_limits, '
                'or engine.torque_n_m in place of it',
                key='engine.torque_share',
            )
        torques = tuple(share * limits.most_torque for share in self.torque_share)
        return replace(self, torque_n_m=torques, torque_share=())


@dataclass(frozen=True)
class EngineAuthority(OptionGroup, prefix='engine_authority.'):
    """
    Limits of size and rate of a controller's deviation from the driver's torque demand.

    Without requests there is no deviation, and the engine delivers the demand. By default it
    follows any request at once, as the thesis assumes (Section 4.3).
    """

    deviation_n_m: float = option(
        1000.0,
        "how far a controller that commands the engine may move it from the driver's demand",
        'N m',
        source='Section 4.3',
        at_least=0.0,
        at_most=MOST_AUTHORITY,
    )
    slew_n_m_s: float = option(
        MOST_AUTHORITY,
        'largest rate of that deviation',
        'N m/s',
        source='Section 4.3',
        at_least=0.0,
        at_most=MOST_AUTHORITY,
    )
    lag_s: float = option(
        0.0,
        'time constant of the first-order lag of that deviation; 0 is none',
        's',
        source='Section 4.3',
        at_least=0.0,
        at_most=MOST_AUTHORITY,
    )
    minimum_torque_n_m: float = option(
        0.0, 'lowest torque then delivered', 'N m', at_least=-1e4, at_most=1e4
    )
    maximum_torque_n_m: float = option(
        1000.0, 'highest torque then delivered', 'N m', at_least=-1e4, at_most=1e4
    )

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        super().__post_init__()
        if self.minimum_torque_n_m >= self.maximum_torque_n_m:
            raise ParameterError(
                f'engine_authority.minimum_torque_n_m is {self.minimum_torque_n_m:g} N m: it must '
                f'be below maximum_torque_n_m, {self.maximum_torque_n_m:g} N m',
                key='engine_authority.minimum_torque_n_m',
            )

    @property
    def lag_share(self) -> float:
        """Share of a constant requested deviation that is reached within one period."""
        return 1.0 - math.exp(-PERIOD_S / self.lag_s) if self.lag_s > 0.0 else 1.0


class EngineResponse:
    """Response of an engine to requests within its authority, with its state between periods."""

    def __init__(self, authority: EngineAuthority) -> None:
        """Start at the demand."""
        self._authority = authority
        self._most_change = authority.slew_n_m_s * PERIOD_S
        self.requested = 0.0
        """Requested deviation from the demand in N m, limited, before the lag."""
        self.deviation = 0.0
        """Delivered deviation from the demand in N m, after the lag."""

    def deliver(self, demand: float, request: float) -> float:
        """
        Return C_m in N m over the coming period for a request in N m.

        The deviation is limited, then its rate; it passes the lag; then the torque is limited.
        """
        limits = self._authority
        requested = _limited(request - demand, limits.deviation_n_m)
        self.requested += _limited(requested - self.requested, self._most_change)
        self.deviation += limits.lag_share * (self.requested - self.deviation)
        torque = demand + self.deviation
        return min(max(torque, limits.minimum_torque_n_m), limits.maximum_torque_n_m)

    def reachable(self, demand: float, periods: int) -> tuple[float, float]:
        """
        Return the lowest and the highest deviation in N m that may be requested `periods` ahead.

        Within them the torque keeps its limits, as far as the rate allows; 1 is the coming period.
        """
        limits, requested, change = self._authority, self.requested, periods * self._most_change
        lowest = _limited(limits.minimum_torque_n_m - demand, limits.deviation_n_m)
        highest = _limited(limits.maximum_torque_n_m - demand, limits.deviation_n_m)
        return requested + _limited(lowest - requested, change), requested + _limited(
            highest - requested, change
        )


class Engine:
    """
    An engine whose torque C_m is held over the 10 ms period that starts at its stamp.

    The thesis's engine delivers the demanded torque at once (Section 1.4.3). A controller with two
    inputs may request another torque (Section 4.3), within the engine's authority.
    """

    def __init__(
        self,
        profile: TorqueProfile,
        authority: EngineAuthority | None = None,
        limits: EngineLimits | None = None,
    ) -> None:
        """
        Start at the demand.

        Without `authority` it follows any request at once, without `limits` at any speed.
        """
        self._profile = profile
        self._limited = LimitedEngine(limits) if limits else None
        self._response = EngineResponse(authority or EngineAuthority())

    def demand(self, step: int) -> float:
        """Return the driver's torque demand in N m at step `step`."""
        return self._profile.at(time_of_step(step))

    def torque(self, demand: float, request: float | None = None, speed: float = 0.0) -> float:
        """
        Return the torque C_m in N m delivered over a period whose demand in N m is given.

        It is the demand, or the response to `request` in N m, within the engine's limits at
        w_m = `speed` in rad/s. With requests or limits it is called once per step, in order.
        """
        requested = demand if request is None else self._response.deliver(demand, request)
        return requested if self._limited is None else self._limited.deliver(requested, speed)


def _limited(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)
