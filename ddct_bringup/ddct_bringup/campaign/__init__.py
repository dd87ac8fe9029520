# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Campaigns of many headless runs: specification, rows of results, and worker processes."""
