# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics that have a floor, with their units; cheap to import."""

from collections.abc import Mapping

FRICTION = 'friction_energy'
"""Metric whose bound has a closed form."""
OF_STICK_SLIP = 'slip_acceleration_at_lock'
"""Metric that only a clutch that sticks has."""
METRICS: Mapping[str, str] = {
    'peak_jerk': 'm/s^3',
    'peak_acceleration': 'm/s^2',
    'traction': 'm/s^2',
    'acceleration_std_m_s2': 'm/s^2',
    'torsion_speed_std_rpm': 'rpm',
    OF_STICK_SLIP: 'rad/s^2',
    'weighted_acceleration': 'm/s^2',
    FRICTION: 'J',
}
"""Units of the metrics that have a floor, by name."""
