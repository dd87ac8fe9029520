# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Statistics of a benchmark: paired dominance, and gaps between development and held-out cases."""
