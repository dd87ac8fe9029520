# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verification of a linear controller in the loop as it runs: sampled, held, delayed, worn."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.design.analysis.loop_curve import (
    LoopCurve,
    Measure,
    complementary,
    sensitivity,
)
from ddct_controllers.design.analysis.loops import WEAR_RANGE, sampled_loop
from ddct_controllers.design.analysis.margins import LoopMargins, closed_loop_stable, loop_margins
from ddct_controllers.design.analysis.step_response import rise_time_and_overshoot
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters

LARGEST_SENSITIVITY_PEAK = 2.0
"""Bound on M_s, whatever the overshoot: at least 30 degrees and 6 dB of margin."""
_RESPONSE_LENGTH = 40.0
"""Length of the step response in specified rise times."""


@dataclass(frozen=True)
class Contour:
    """A closed curve that L has to stay out of, with the peak and the crossings of L."""

    name: str
    """Name of the curve's function: S or T."""
    level: float
    """Level of the curve: S_p or T_p."""
    peak: float
    """Peak M_s or M_t of the loop."""
    peak_rad_s: float
    """Frequency of the peak in rad/s."""
    inside_rad_s: tuple[tuple[float, float], ...]
    """
    First and last frequency in rad/s of every stretch of L inside the curve.

    The last stretch may end at the end of the grid.
    """

    respected: bool
    """Whether L stays out of the curve."""


@dataclass(frozen=True)
class LoopVerification:
    """Quantities of the sampled loop with hold and delay, beside the specifications."""

    specifications: TimeSpecifications
    margins: LoopMargins
    rise_time_s: float | None
    """
    Rise time in s; None when the output does not reach the final value in the response's time.
    """
    overshoot: float | None
    """Overshoot as a fraction of the final value; None for an unstable loop."""
    contours: tuple[Contour, ...]
    """Behaviour of L at the curves of S_p and T_p."""
    stable_when_worn: tuple[bool, ...]
    """Whether the loop is stable, at each end of WEAR_RANGE."""

    @property
    def rejections(self) -> tuple[str, ...]:
        """Reasons to refuse the controller; empty for a good one."""
        if not self.margins.stable:
            return ('the closed loop is unstable',)
        reasons = []
        limit_s, limit = self.specifications.rise_time_s, self.specifications.overshoot
        if self.rise_time_s is None or self.rise_time_s > limit_s:
            reached = 'never' if self.rise_time_s is None else f'{self.rise_time_s:.3f} s'
            reasons.append(f'rise time {reached}, above {limit_s:g} s')
        if self.overshoot is None or self.overshoot > limit:
            reasons.append(f'overshoot above {100.0 * limit:g} %')
        peak = self.margins.sensitivity_peak
        if peak is None or peak > LARGEST_SENSITIVITY_PEAK:
            reasons.append(f'sensitivity peak M_s above {LARGEST_SENSITIVITY_PEAK:g}')
        for wear_gain, stable in zip(WEAR_RANGE, self.stable_when_worn, strict=True):
            if not stable:
                reasons.append(f'unstable with wear gain {wear_gain:g}')
        return tuple(reasons)

    @property
    def respects_contours(self) -> bool:
        """Whether L stays out of the S_p and the T_p curve."""
        return self.margins.stable and all(contour.respected for contour in self.contours)


def verify(
    controller: FactoredTransferFunction,
    specifications: TimeSpecifications,
    parameters: DrivelineParameters,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> LoopVerification:
    """Return the quantities of the sampled loop with the controller, discretised as in the run."""
    sampled = discretise_zoh(controller.to_state_space(), PERIOD_S)
    loop = sampled_loop(sampled, parameters, actuator=actuator)
    margins = loop_margins(loop)
    stable_when_worn = tuple(
        closed_loop_stable(sampled_loop(sampled, parameters, wear_gain, actuator))
        for wear_gain in WEAR_RANGE
    )
    if not margins.stable:
        return LoopVerification(specifications, margins, None, None, (), stable_when_worn)
    rise_s, overshoot = rise_time_and_overshoot(
        loop, _RESPONSE_LENGTH * specifications.rise_time_s
    )
    at_contours = contours(LoopCurve(loop), specifications)
    return LoopVerification(
        specifications, margins, rise_s, overshoot, at_contours, stable_when_worn
    )


def contours(curve: LoopCurve, specifications: TimeSpecifications) -> tuple[Contour, Contour]:
    """Return the behaviour of L at the S_p and the T_p curve of the specifications."""
    return (
        _contour(curve, 'S', specifications.sensitivity_peak, sensitivity),
        _contour(curve, 'T', specifications.complementary_peak, complementary),
    )


def _contour(curve: LoopCurve, name: str, level: float, measure: Measure) -> Contour:
    def excess(values: np.ndarray) -> np.ndarray:
        return measure(values) - level

    bounds = list(curve.crossings(excess))
    if excess(curve.values[:1])[0] > 0.0:
        bounds.insert(0, float(curve.omega[0]))
    if len(bounds) % 2:
        bounds.append(float(curve.omega[-1]))
    stretches = tuple(zip(bounds[0::2], bounds[1::2], strict=True))
    return Contour(name, level, *curve.peak(measure), stretches, respected=not stretches)
