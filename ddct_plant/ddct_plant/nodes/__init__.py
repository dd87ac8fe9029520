# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plant's ROS 2 nodes: thin shells around the models."""
