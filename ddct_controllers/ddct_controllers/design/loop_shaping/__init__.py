# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Loop shaping (Chapter 2): specifications, networks, Nyquist and Nichols, search."""
