# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Data of the thesis: Table 5.1 as printed, and which rows the scenario was fitted to."""
