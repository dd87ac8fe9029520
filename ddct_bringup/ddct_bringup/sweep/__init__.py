# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs over the values of one key or two: `sweep`, the short form of a campaign."""
