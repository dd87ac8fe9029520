# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time stepping: the owner of time, the join of inputs and the limits of stamps; no ROS."""
