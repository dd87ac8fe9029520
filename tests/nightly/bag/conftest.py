# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bags of made-up runs."""

from support.made_bags import bags, make_trajectory, trajectory

__all__ = ['bags', 'make_trajectory', 'trajectory']
