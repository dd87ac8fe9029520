# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Reproduction of the thesis: its numbers, figures, studies and calibration."""
