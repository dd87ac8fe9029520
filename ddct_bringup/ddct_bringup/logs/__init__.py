# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Logs of other tools and recorded bags: quantities by name, in SI units."""
