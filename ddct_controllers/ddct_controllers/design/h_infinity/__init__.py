# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""H-infinity synthesis (Chapter 3): weights, problem, Riccati and LMI solutions, cleaning."""
