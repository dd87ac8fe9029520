# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Specification of a tuning: parameters, objectives, constraints, cases."""
