# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Handovers of a gear shift: how the torque goes from the off-going to the on-coming clutch."""
