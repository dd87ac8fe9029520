# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of runs: launches, shifts, floors, the benchmark, and the feedforward."""
