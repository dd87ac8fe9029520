# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs of the simulated plant near a bound: what a run attains."""
