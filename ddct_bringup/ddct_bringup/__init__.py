# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Start, record and score closed-loop runs, with ROS 2 or without."""

# First of all imports: it chooses the kernel of linear algebra before numpy is loaded.
import ddct_plant  # noqa: F401
