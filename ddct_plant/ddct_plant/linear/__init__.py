# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear systems: their forms, realisations and exact discretisation."""
