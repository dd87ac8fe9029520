# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Fit of the scenario to rows of the thesis's Table 5.1."""
