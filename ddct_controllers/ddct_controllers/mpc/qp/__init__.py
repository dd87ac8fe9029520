# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quadratic programs of the predictive controllers, behind one small backend interface."""
