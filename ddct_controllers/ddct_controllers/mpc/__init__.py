# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Model predictive controllers of the clutch."""
