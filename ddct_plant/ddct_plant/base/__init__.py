# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Errors, checks, options, units and the time base: the foundation of all packages."""
