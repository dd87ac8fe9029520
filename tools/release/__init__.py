# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""sdists and wheels of the four packages, tried in an empty environment without ROS."""
