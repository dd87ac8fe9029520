# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Statistics of runs, by arrays alone: outcomes, shares, boundaries, drivers and differences."""
