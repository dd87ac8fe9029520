# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One run: its plan, the graph or headless loop that executes it, and its output folder."""
