# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time specifications, and their bounds on S, T and L by the second-order prototype."""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.printed import ACTUATOR

LONGEST_RISE_TIME_S = 5.0
"""Longest rise time in s; an engagement takes about a second."""


@dataclass(frozen=True)
class TimeSpecifications:
    """
    Rise time and overshoot of the step response, with their translation (Sections 2.2 and 3.2).

    The prototype is T(s) = w_n^2 / (s^2 + 2 zeta w_n s + w_n^2), L = w_n^2 / (s (s + 2 zeta w_n)).
    """

    rise_time_s: float
    """Rise time t_r in s, until the first crossing of the final value."""
    overshoot: float
    """Overshoot s^ as a fraction of the final value: 0.14 is 14 %."""

    def __post_init__(self) -> None:
        """Check both; raise ParameterError that names a bad one."""
        require_number(
            'rise time', self.rise_time_s, unit='s', above=0.0, at_most=LONGEST_RISE_TIME_S
        )
        percent = 100.0 * require_number('overshoot', self.overshoot)
        require_number('overshoot', percent, unit='%', above=0.0)
        if percent >= 100.0:
            raise ParameterError(
                f'overshoot is {percent:g} %: it must be below 100 %, where oscillation never '
                'ends',
                key='overshoot',
            )

    @property
    def damping(self) -> float:
        """Least damping zeta = |ln s^| / sqrt(pi^2 + ln^2 s^)."""
        logarithm = math.log(self.overshoot)
        return -logarithm / math.hypot(math.pi, logarithm)

    @property
    def sensitivity_peak(self) -> float:
        """
        S_p = 2 zeta sqrt(2 + 4 zeta^2 + 2 r) / (r + 4 zeta^2 - 1), r = sqrt(1 + 8 zeta^2).

        It is max |S| of the prototype, and the bound on that of the loop.
        """
        damping = self.damping
        root = math.sqrt(1.0 + 8.0 * damping**2)
        above = 2.0 * damping * math.sqrt(2.0 + 4.0 * damping**2 + 2.0 * root)
        return above / (root + 4.0 * damping**2 - 1.0)

    @property
    def complementary_peak(self) -> float:
        """
        T_p = 1 / (2 zeta sqrt(1 - zeta^2)), and 1 from zeta = 1/sqrt(2) on.

        It is max |T| of the prototype, and the bound on that of the loop.
        """
        damping = self.damping
        if damping >= math.sqrt(0.5):
            return 1.0
        return 1.0 / (2.0 * damping * math.sqrt(1.0 - damping**2))

    @property
    def natural_frequency_rad_s(self) -> float:
        """Least w_n in rad/s, (pi - arccos zeta) / (t_r sqrt(1 - zeta^2)) (Section 3.2)."""
        return rise_angle(self.damping) / self.rise_time_s

    @property
    def crossover_rad_s(self) -> float:
        """Least crossover w_c in rad/s, from t_r w_c at this zeta."""
        return rise_time_crossover_product(self.damping) / self.rise_time_s


def rise_angle(damping: float) -> float:
    """
    Return w_n t_r = (pi - arccos zeta) / sqrt(1 - zeta^2) of the prototype.

    Section 3.2 prints the numerator without its minus sign.
    """
    return (math.pi - math.acos(damping)) / math.sqrt(1.0 - damping**2)


def crossover_ratio(damping: float) -> float:
    """Return w_c / w_n = sqrt(sqrt(1 + 4 zeta^4) - 2 zeta^2), where |L| of the prototype is 1."""
    return math.sqrt(math.sqrt(1.0 + 4.0 * damping**4) - 2.0 * damping**2)


def rise_time_crossover_product(damping: float) -> float:
    """Return t_r w_c of the prototype: the curve of Figure 2.2."""
    return rise_angle(damping) * crossover_ratio(damping)


def prototype_phase_margin(damping: float) -> float:
    """Return pi + arg L(j w_c) = arctan(2 zeta w_n / w_c) of the prototype, in rad."""
    return math.atan2(2.0 * damping, crossover_ratio(damping))


def unavoidable_lag(omega: float) -> float:
    """
    Return the phase lag at `omega` that no stable controller can remove, in rad.

    It is that of the actuator's delay of one period, of the hold, half a period, and of the
    all-pass part of G_a: (1 - s/z)/(1 + s/z*) for each zero z in the right half-plane.
    """
    zeros, s = ACTUATOR.zeros[ACTUATOR.zeros.real > 0.0], 1j * omega
    mirrored = -np.conj(zeros)
    all_pass = (1.0 - s / zeros) / (1.0 - s / mirrored)
    return 1.5 * PERIOD_S * omega - float(np.sum(np.angle(all_pass)))


def highest_crossover_rad_s(damping: float) -> float:
    """
    Return the crossover at which the unavoidable lag uses up the phase that zeta leaves.

    A loop that falls by 20 dB per decade there has lost pi/2; the prototype's phase margin is to
    stay. A flatter loop gains little: it crosses more than once or has no gain margin left.
    """
    allowed = math.pi / 2.0 - prototype_phase_margin(damping)
    return float(
        scipy.optimize.brentq(
            lambda omega: unavoidable_lag(omega) - allowed, 1e-9, math.pi / PERIOD_S
        )
    )


def require_reachable(specifications: TimeSpecifications) -> None:
    """Raise ParameterError with the bound when the required crossover is above it."""
    damping, crossover = specifications.damping, specifications.crossover_rad_s
    bound = highest_crossover_rad_s(damping)
    if crossover > bound:
        slowest = rise_time_crossover_product(damping) / bound
        raise ParameterError(
            f'rise time {specifications.rise_time_s:g} s with overshoot '
            f'{100.0 * specifications.overshoot:g} % asks for a crossover of {crossover:.3g} '
            f"rad/s, but the actuator's delay, hold and right-half-plane zeros allow {bound:.3g} "
            f'rad/s: allow a rise time of {slowest:.2g} s or more overshoot',
            key='rise time',
        )
