# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The graph for minutes in real time, beside a bare chain."""
