# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tune the options of a controller: search, trials, front, and the figures on held-out cases."""
