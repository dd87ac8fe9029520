# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Models of engine, load, clutch, driveline, vehicle and actuator; no ROS, no clock."""
