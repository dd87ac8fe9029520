# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lock-step runs of the graph on busy cores."""
