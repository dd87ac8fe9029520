# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear systems with dry friction that sticks, integrated exactly; no ROS, no clock."""
