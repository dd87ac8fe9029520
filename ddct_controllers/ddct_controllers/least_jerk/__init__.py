# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A clutch controller that locks the plates along the torque of least jerk."""
