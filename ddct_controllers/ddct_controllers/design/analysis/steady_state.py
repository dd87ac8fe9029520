"""The steady-state requirement: how many integrators G_c needs, by the final-value theorem."""

import numpy as np

from ddct_controllers.design.loop_shaping.specifications import SpecificationError
from ddct_plant.linear.lti import FactoredTransferFunction


def poles_at_zero(transfer_function: FactoredTransferFunction) -> int:
    """Return the number of poles at s = 0, less that of zeros there."""
    poles = np.count_nonzero(transfer_function.poles == 0.0)
    return int(poles - np.count_nonzero(transfer_function.zeros == 0.0))


def required_integrators(
    plant: FactoredTransferFunction,
    disturbance_path: FactoredTransferFunction,
    disturbance_order: int = 0,
) -> int:
    """
    Return mu, the least number of poles at 0 in G_c for no error from a disturbance at t = inf.

    The disturbance is D_p0 / s^(h + 1), h = `disturbance_order`: 0 a step, 1 a ramp. It reaches
    the output through `disturbance_path` with q poles at 0 (P_1: q = 1), the loop through `plant`
    with p. e = s |path / (1 + L)| D_p0 / s^(h + 1) goes as s^(mu + p - q - h), so that
    mu + p >= q + h + 1; Section 2.2 writes it for P_1, mu + p >= 2.
    """
    if disturbance_order < 0:
        raise SpecificationError(
            f'disturbance order is {disturbance_order}: it must be 0 (a step), 1 (a ramp) or more'
        )
    needed = poles_at_zero(disturbance_path) + disturbance_order + 1
    return max(0, needed - poles_at_zero(plant))
