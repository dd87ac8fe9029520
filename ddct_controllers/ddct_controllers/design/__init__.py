# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Design and analysis of linear slip-speed controllers: loops, margins, step responses."""
