# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs with boxed variables, linear and quadratic: solvers, and proofs of bounds."""
