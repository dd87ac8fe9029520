# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities that a campaign evaluates: figures and metrics of which less is better."""

from ddct_bringup.metrics.catalogue import REPEATABLE

QUANTITIES = tuple(each for each in REPEATABLE if each.smaller_is_better)
"""Figures and further metrics by column; for each a smaller magnitude is better."""
