"""Check of what is measured."""

import math

from ddct_controllers.interface import Measurement
from ddct_plant.errors import DdctError


def measured_speeds(measurement: Measurement) -> tuple[float, float, float]:
    """Return w_m, w_p, w_r in rad/s; raise DdctError when one is not finite."""
    speeds = (measurement.engine_speed, measurement.shaft_speed, measurement.wheel_speed)
    if not math.isfinite(sum(speeds)):
        raise DdctError(
            f'speeds w_m, w_p, w_r are {speeds} rad/s at step {measurement.step}: '
            'mend what measures them'
        )
    return speeds
