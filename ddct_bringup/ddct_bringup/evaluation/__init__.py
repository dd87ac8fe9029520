# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The summary of many runs from the table of their rows, and the statistics in it."""
