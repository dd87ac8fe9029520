# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The quadratic program of cost, horizon and limits, and its data at each step."""
