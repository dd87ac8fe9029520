# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of `ddct limit` that are figures or metrics of a run too."""

SCORED = {
    'peak_jerk': 'peak_jerk_m_s3',
    'traction': 'driving_acceleration_m_s2',
    'acceleration_std_m_s2': 'acceleration_std_m_s2',
    'torsion_speed_std_rpm': 'torsion_speed_std_rpm',
    'weighted_acceleration': 'weighted_acceleration_m_s2',
}
"""Key in `scores.json` by the name of the metric that has a floor."""
