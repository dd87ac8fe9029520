# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Simulation of many runs of linear plants and controllers at once, one array column per run."""
