# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Output of a benchmark: its result, its page, and its tables for the terminal."""
