# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics and criteria of a run: each is declared once, for one run and for many."""
