# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Clutch controllers, their interface and their registry."""

# First of all imports: it chooses the kernel of linear algebra before numpy is loaded.
import ddct_plant  # noqa: F401
