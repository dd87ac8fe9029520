"""How fast any loop through this actuator can be: its delay, hold and right-half-plane zeros."""

import math

import numpy as np
from scipy.optimize import brentq

from ddct_controllers.design.loop_shaping.specifications import (
    SpecificationError,
    TimeSpecifications,
    prototype_phase_margin,
    rise_time_crossover_product,
)
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.printed import ACTUATOR

_FASTEST_RAD_S = math.pi / PERIOD_S


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
    return float(brentq(lambda omega: unavoidable_lag(omega) - allowed, 1e-9, _FASTEST_RAD_S))


def require_reachable(specifications: TimeSpecifications) -> None:
    """Raise SpecificationError with the bound when the crossover asked for is above it."""
    damping, wanted = specifications.damping, specifications.crossover_rad_s
    bound = highest_crossover_rad_s(damping)
    if wanted > bound:
        slowest = rise_time_crossover_product(damping) / bound
        raise SpecificationError(
            f'rise time {specifications.rise_time_s:g} s with overshoot '
            f'{100.0 * specifications.overshoot:g} % asks for a crossover of {wanted:.3g} rad/s, '
            f"but the actuator's delay, hold and right-half-plane zeros allow {bound:.3g} rad/s: "
            f'allow a rise time of {slowest:.2g} s or more overshoot'
        )
