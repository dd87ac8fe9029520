# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Analysis of sampled loops: margins, corners of plant and wear, step responses."""
