# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Computed values for the numbers of the thesis."""
