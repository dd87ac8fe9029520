# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Recordings of runs as rosbag2 bags: write, read and check them."""
