# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of a gear shift: its phases, and what both clutches do in them."""
