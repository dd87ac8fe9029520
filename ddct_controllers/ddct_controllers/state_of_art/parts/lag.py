"""The lag between a clutch torque request and the torque, as one time constant."""

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.cascade import Factor
from ddct_plant.models.printed import ACTUATOR


def _time_constant_s(factor: Factor) -> float:
    """Return the derivative of ln(s + a), or of ln(s^2 + b s + c), at s = 0."""
    return factor[0] / factor[1] if isinstance(factor, tuple) else 1.0 / factor


ACTUATION_LAG_S = (
    PERIOD_S
    + sum(_time_constant_s(factor) for factor in ACTUATOR.denominator)
    - sum(_time_constant_s(factor) for factor in ACTUATOR.numerator)
)
"""About 43 ms: the delay and -d ln G_a/ds at s = 0 (Section 1.4.2)."""
