# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Simulation of many runs at once; the runs are the first axis of every array of a step."""
