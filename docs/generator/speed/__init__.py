# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables and charts of measured speed, and of latencies in real time."""
