"""Section 3.2.1: the weights with the numbers that the thesis prints, not with their sources."""

from ddct_controllers.design.h_infinity.recipes import HinfWeights
from ddct_controllers.design.h_infinity.weights import ComplementaryWeight, SensitivityWeight

PRINTED_WEIGHTS = HinfWeights(
    SensitivityWeight(low_frequency_gain=0.15, peak=1.33),
    ComplementaryWeight(peak=1.02, corner_rad_s=28.0),
    effort=None,
    sampled=False,
    back_off=1.0,
)
"""K, S_p, T_p and w_2 as printed; at the optimum, as the thesis's synthesis is."""
