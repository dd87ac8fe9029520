"""Friction clutch: what the plates can carry for the actuator's torque, kinetic and static."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ddct_plant.base.checks import require_curve, require_number

AMBIENT_C = 20.0
"""Temperature at which the actuator's map from position to torque holds."""


@dataclass(frozen=True)
class FrictionParameters:
    """Friction between the plates, section `friction` of a scenario; none is measured here."""

    static_over_kinetic: float = 1.0
    """Static over kinetic capacity, at least 1; assumed: no figure for this facing is public."""
    temperature_c: tuple[float, ...] = (250.0, 300.0, 400.0)
    """
    Facing temperatures in degrees Celsius of `temperature_share`, rising.

    Friction declines sharply above 250 to 300 degrees, where the phenol resin decomposes
    ("Simulation of engagement control in automotive dry-clutch and temperature field analysis",
    abstract); 400 is assumed.
    """
    temperature_share: tuple[float, ...] = (1.0, 0.8, 0.4)
    """Friction there over that of a cold facing, linear between, constant outside; assumed."""
    slip_rad_s: tuple[float, ...] = ()
    """
    Sizes of the slip speed in rad/s of `slip_share`, rising; none: friction does not depend on it.

    Published work disagrees: little or no dependence (Myklebust and Eriksson 2012), or friction
    that falls with slip speed (Gkinis et al.).
    """
    slip_share: tuple[float, ...] = ()
    """Friction there over that at rest, linear between, constant outside; assumed where given."""
    kiss_torque_n_m: float = 0.0
    """Actuator torque in N m below which the cold plates do not touch; 0 assumed: a true map."""
    kiss_drift_n_m_k: float = 0.0
    """
    Fall of the kiss point in N m of actuator torque per K that the facing is above 20 degrees.

    Positive: the facings expand, so a hot clutch carries more at one actuator position (up to
    900 N m in a truck clutch, Myklebust and Eriksson 2012). 0 assumed.
    """

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        require_number(
            'friction.static_over_kinetic', self.static_over_kinetic, at_least=1.0, at_most=3.0
        )
        for x, y in (('temperature_c', 'temperature_share'), ('slip_rad_s', 'slip_share')):
            require_curve(
                f'friction.{x}',
                getattr(self, x),
                f'friction.{y}',
                getattr(self, y),
                y_at_least=0.0,
                y_at_most=3.0,
            )
        require_number('friction.kiss_torque_n_m', self.kiss_torque_n_m, at_least=0.0, at_most=1e3)
        require_number(
            'friction.kiss_drift_n_m_k', self.kiss_drift_n_m_k, at_least=-10.0, at_most=10.0
        )


@dataclass(frozen=True, slots=True)
class Capacity:
    """What the clutch can carry at 0, 1, ..., 10 ms of a period, in N m, never negative."""

    kinetic: list[float]
    """(11,) while it slips."""
    static: list[float]
    """(11,) while it sticks, at least the kinetic one."""


class FrictionClutch:
    """
    Capacity for the actuator's torque, at a facing temperature T and a slip speed w_d.

    c_kin = K_usura mu(T) mu(w_d) (C_a - C_kiss(T)) where that is positive and the actuator
    presses (C_a > 0), else 0, with C_kiss(T) = kiss_torque - kiss_drift (T - 20). A requested
    torque of zero opens the clutch beyond any kiss point, so nothing is carried there.
    The static capacity is that of the same slip speed times `static_over_kinetic`: so it is never
    below the kinetic one, whatever the curve over slip speed.
    """

    def __init__(self, parameters: FrictionParameters, wear_gain: float = 1.0) -> None:
        """Take the friction and K_usura, 1 for a new facing."""
        self._parameters = parameters
        self._wear_gain = require_number('wear_gain', wear_gain, above=0.0, at_most=3.0)

    def capacity(
        self,
        actuator_torque: Sequence[float],
        temperature_c: float = AMBIENT_C,
        slip_speed: float = 0.0,
    ) -> Capacity:
        """
        Return what can be carried at the instants of `actuator_torque`, in N m.

        The facing's temperature in degrees Celsius and the slip speed in rad/s, of either sign,
        are those at the start of the period and hold throughout it: that makes the work of a hot,
        fading launch of 38 kJ 0.24 % larger and its lock-up 3 ms later.
        """
        p = self._parameters
        gain = self._wear_gain * _curve(p.temperature_c, p.temperature_share, temperature_c)
        gain *= _curve(p.slip_rad_s, p.slip_share, abs(slip_speed))
        kiss = p.kiss_torque_n_m - p.kiss_drift_n_m_k * (temperature_c - AMBIENT_C)
        kinetic = [
            gain * max(torque - kiss, 0.0) if torque > 0.0 else 0.0 for torque in actuator_torque
        ]
        return Capacity(kinetic, [p.static_over_kinetic * torque for torque in kinetic])


def _curve(xs: Sequence[float], ys: Sequence[float], x: float) -> float:
    if not xs:
        return 1.0
    # Where most runs stay; numpy takes longer than the rest of the clutch.
    return ys[0] if x <= xs[0] else float(np.interp(x, xs, ys))
