# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of the torques of a log."""

TORQUES = ('engine_torque', 'clutch_torque')
"""Names of C_m and C_f, which a log must have."""
LOAD = 'load_torque'
"""Name of C_load, which a log may have."""
