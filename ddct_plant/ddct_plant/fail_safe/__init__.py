# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Fail-safe of a real-time run whose requests or torques stop; no ROS."""
