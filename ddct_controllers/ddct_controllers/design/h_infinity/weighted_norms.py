"""Peaks of the weighted S and T of a loop: what Section 3.2.2 judges a controller by."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_controllers.design.h_infinity.weights import ComplementaryWeight, SensitivityWeight
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace


@dataclass(frozen=True)
class WeightedNorms:
    """Peaks over frequency; each below 1 meets its requirement."""

    sensitivity: float
    """||W_s S||, with the poles of W_s at 0."""
    complementary: float
    """||W_t T||."""
    uncertainty: float
    """||W_u T||: robust stability for all K_usura."""
    stack: float
    """||[W_s S; W_t T]||."""


def weighted_norms(
    loop: ContinuousLoop | StateSpace,
    w_s: SensitivityWeight,
    w_t: ComplementaryWeight,
    w_u: FactoredTransferFunction,
) -> WeightedNorms:
    """Return the norms of a stable loop, on a grid that is dense around the poles."""
    curve = LoopCurve(loop)
    sensitivity = np.abs(1.0 / (1.0 + curve.values))
    complementary = np.abs(curve.values) * sensitivity
    first = sensitivity * np.abs(w_s.transfer_function().frequency_response(curve.omega))
    second = complementary * np.abs(w_t.transfer_function().frequency_response(curve.omega))
    third = complementary * np.abs(w_u.frequency_response(curve.omega))
    return WeightedNorms(
        *(float(np.max(x)) for x in (first, second, third, np.hypot(first, second)))
    )
