# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verify results: repeat the runs of a folder headless and compare them."""
