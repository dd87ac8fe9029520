# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Map, charts and tables of the pages about robustness."""
