# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""ROS 2 plumbing that every node of the project shares."""
