# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scores computed from a recording, and the tables that show them."""
