# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of the metrics of Table 5.1; cheap to import."""

TABLE_METRICS = ('engagement_time_s', 'torsion_speed_std_rpm', 'acceleration_std_m_s2')
"""Metrics of Table 5.1, in the order of its columns."""
