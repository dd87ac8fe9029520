# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Start, record and score closed-loop runs, with ROS 2 or without."""
