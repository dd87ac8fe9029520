# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table of topics and signals, and the adapters of their message types; no node, no wire."""
