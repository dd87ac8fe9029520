# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Predictive controllers as C for a control unit (thesis Section 6.1)."""
