"""What we compute for the numbers of Chapter 4, predictive control."""

from ddct_bringup.reproduction.numbers.thesis_number import Value
from ddct_controllers.mpc.costs import TABLE_4_1

_OUTPUT_WEIGHT, _RATE_WEIGHT = 1.0, 0.1
"""Defaults of MATLAB's mpcDesigner; its slider multiplies the one and divides the other."""


def predictive_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file: R for one position of the slider."""
    return {
        f'4.1 {name} R': _OUTPUT_WEIGHT * _RATE_WEIGHT / row.output_weight
        for name, row in TABLE_4_1.items()
    }
