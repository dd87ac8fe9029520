# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Actuators of other cars for tests: slower, faster, at once, and with a part of a period."""

from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters

SLOW = ActuatorParameters(delay_s=0.02, bandwidth_factor=0.6)
FAST = ActuatorParameters(delay_s=0.005, bandwidth_factor=2.0)
AT_ONCE = ActuatorParameters(delay_s=0.0)
BETWEEN = ActuatorParameters(delay_s=0.013, bandwidth_factor=0.8)
LATE = ActuatorParameters(delay_s=0.034, bandwidth_factor=0.5)
ACTUATORS = {
    'printed': PRINTED_ACTUATOR,
    'slow': SLOW,
    'fast': FAST,
    'at once': AT_ONCE,
    'between': BETWEEN,
    'late': LATE,
}
"""Actuators by name, the printed one first."""


def keys_of(actuator: ActuatorParameters) -> dict[str, float]:
    """Return the keys of a scenario with this actuator."""
    return {
        'actuator.delay_s': actuator.delay_s,
        'actuator.bandwidth_factor': actuator.bandwidth_factor,
    }
