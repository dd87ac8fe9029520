# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Names of the two sides of a gear shift.

It imports nothing, because the program `ddct` reads it before it loads any other.
"""

ON_COMING, OFF_GOING = 'on_coming', 'off_going'
ROLES = (ON_COMING, OFF_GOING)
"""Sides of a gear shift; without a shift there is the first one alone."""
