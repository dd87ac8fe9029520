# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Clutch models: from the actuator's torque to the torque between the plates."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ddct_plant.base.clutch_kinds import WEAR_GAIN
from ddct_plant.base.options import ASSUMED, OptionGroup, option
from ddct_plant.models.clutch_heat import ClutchHeat, HeatParameters

AMBIENT_C = 20.0
"""Temperature in degrees Celsius at which the actuator's map from position to torque is valid."""


class LinearClutch:
    """
    The thesis's clutch: it transmits the actuator's torque times the wear gain K_usura.

    The thesis has K_usura inside the actuator, before the delay and G_a(s) (Section 1.4.2); a
    constant gain commutes with both, so here it is the clutch's, whose friction wears.
    """

    def __init__(self, wear_gain: float = WEAR_GAIN.default) -> None:
        self._wear_gain = WEAR_GAIN.checked('wear_gain', wear_gain)

    def transmit(self, actuator_torque: Sequence[float]) -> list[float]:
        """Return the transmitted torque in N m at the same instants as `actuator_torque`."""
        return [self._wear_gain * torque for torque in actuator_torque]


@dataclass(frozen=True)
class FrictionParameters(OptionGroup, prefix='friction.'):
    """
    Friction between the plates; no value for this facing is public.

    It declines sharply above 250 to 300 degrees, where the phenol resin decomposes ("Simulation of
    engagement control in automotive dry-clutch and temperature field analysis", abstract).
    Published work disagrees on the slip speed: little or no dependence (Myklebust and Eriksson
    2012), or friction that falls with it (Gkinis et al.).
    """

    static_over_kinetic: float = option(
        1.0, 'static over kinetic capacity', source=ASSUMED, at_least=1.0, at_most=3.0
    )
    most_n_m: float = option(
        350.0,
        'greatest kinetic capacity, at any request',
        'N m',
        source='Section 1.1: greatest input torque of the C635; assumed for its clutches',
        above=0.0,
        at_most=1e5,
    )
    temperature_c: tuple[float, ...] = option(
        (250.0, 300.0, 400.0),
        'facing temperatures of `temperature_share`',
        '°C',
        source='decline from 250 to 300 °C: resin decomposes; 400 assumed',
        many=True,
        rising=True,
    )
    temperature_share: tuple[float, ...] = option(
        (1.0, 0.8, 0.4),
        'friction there over that of a cold facing, linear between, constant outside',
        source=ASSUMED,
        many=True,
        at_least=0.0,
        at_most=3.0,
    )
    slip_rad_s: tuple[float, ...] = option(
        (),
        'sizes of the slip speed of `slip_share`; none: friction does not depend on it',
        'rad/s',
        source='Myklebust and Eriksson 2012',
        many=True,
        rising=True,
    )
    slip_share: tuple[float, ...] = option(
        (),
        'friction there over that at rest, linear between, constant outside',
        many=True,
        at_least=0.0,
        at_most=3.0,
    )
    kiss_torque_n_m: float = option(
        0.0,
        'actuator torque below which the cold plates do not touch; 0: a true map',
        'N m',
        source=ASSUMED,
        at_least=0.0,
        at_most=1e3,
    )
    kiss_drift_n_m_k: float = option(
        0.0,
        'fall of the kiss point per K that the facing is above 20 °C; positive: the facings '
        'expand, so a hot clutch carries more (a truck clutch up to 900 N m, Myklebust and '
        'Eriksson 2012)',
        'N m/K',
        source=ASSUMED,
        at_least=-10.0,
        at_most=10.0,
    )

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        super().__post_init__()
        self.require_pairs('temperature_c', 'temperature_share')
        self.require_pairs('slip_rad_s', 'slip_share')

    @property
    def worn_request(self) -> float:
        """Request in N m with which a clutch worn to a wear gain of 0.7 carries `most_n_m`."""
        return 10.0 * self.most_n_m / 7.0

    @property
    def working_torque(self) -> float:
        """
        Torque in N m that a hard engagement takes of the clutch, 6/7 of `most_n_m`.

        A clutch is made for a sixth more than it has to carry.
        """
        return 6.0 * self.most_n_m / 7.0


class Capacity(NamedTuple):
    """Torque capacities of the clutch at 0, 1, ..., 10 ms of a period, and its temperature."""

    kinetic: list[float]
    """Kinetic capacity in N m, (11,), not negative: the torque while the clutch slips."""
    static: list[float]
    """Static capacity in N m, (11,), at least the kinetic one: the largest torque while it
    sticks."""
    temperature_c: float
    """Temperature of the facing in degrees Celsius, for which the capacities hold."""


class FrictionClutch:
    """
    The stick-slip clutch: its capacity at the temperature T of its facing and a slip speed w_d.

    c_kin = K_usura mu(T) mu(w_d) (C_a - C_kiss(T)) where that is positive and the actuator
    presses (C_a > 0), else 0, with C_kiss(T) = kiss_torque - kiss_drift (T - 20); at most
    `most_n_m`. A requested torque of zero opens the clutch beyond any kiss point, so that the
    capacity is zero.
    The static capacity is the kinetic one at the same slip speed times `static_over_kinetic`, so
    that it is never below the kinetic one, whatever the curve over slip speed.
    """

    def __init__(
        self,
        parameters: FrictionParameters,
        wear_gain: float = WEAR_GAIN.default,
        heat: HeatParameters | None = None,
        open_below: float = 0.0,
    ) -> None:
        """
        Use the friction and K_usura; start at the temperatures of `heat`, by default 20 °C.

        The actuator presses above `open_below` in N m only. Its torque decays after a request of
        zero and does not reach zero: a clutch that has to open in the run needs a value above 0.
        """
        self._parameters = parameters
        self._open_below = open_below
        self._wear_gain = WEAR_GAIN.checked('wear_gain', wear_gain)
        self._heat = ClutchHeat(heat or HeatParameters())
        self._step = 0

    def reply(
        self, step: int, actuator_torque: Sequence[float], slip_speed: float, friction_work: float
    ) -> Capacity:
        """
        Return the capacities of the period of t_k for the (11,) actuator torques in N m.

        `slip_speed` is w_d in rad/s at t_k. `friction_work` in J is that of the last period, which
        warms the clutch first; skipped periods before it, as real time may have, count with the
        same work. Steps rise from call to call.
        """
        for _ in range(self._step, step):
            self._heat.advance(friction_work)
        self._step = step
        return self.capacity(actuator_torque, self._heat.facing_c, slip_speed)

    def capacity(
        self,
        actuator_torque: Sequence[float],
        temperature_c: float = AMBIENT_C,
        slip_speed: float = 0.0,
    ) -> Capacity:
        """
        Return the capacities in N m at the instants of `actuator_torque` in N m.

        The facing's temperature in degrees Celsius and the slip speed in rad/s, of either sign,
        are those at the start of the period and hold throughout it: that makes the work of a hot,
        fading launch of 38 kJ 0.24 % larger and its lock-up 3 ms later.
        """
        p = self._parameters
        gain = self._wear_gain
        if p.temperature_c:
            gain *= _curve(p.temperature_c, p.temperature_share, temperature_c)
        if p.slip_rad_s:
            gain *= _curve(p.slip_rad_s, p.slip_share, abs(slip_speed))
        kiss = p.kiss_torque_n_m - p.kiss_drift_n_m_k * (temperature_c - AMBIENT_C)
        least = max(kiss, self._open_below)
        kinetic = [gain * (torque - kiss) if torque > least else 0.0 for torque in actuator_torque]
        if max(kinetic) > p.most_n_m:
            kinetic = [min(torque, p.most_n_m) for torque in kinetic]
        static = kinetic
        if p.static_over_kinetic != 1.0:
            static = [p.static_over_kinetic * torque for torque in kinetic]
        return Capacity(kinetic, static, temperature_c)


def _curve(xs: Sequence[float], ys: Sequence[float], x: float) -> float:
    # The first branch is that of most runs; numpy takes longer than the rest of the clutch.
    return ys[0] if x <= xs[0] else float(np.interp(x, xs, ys))
