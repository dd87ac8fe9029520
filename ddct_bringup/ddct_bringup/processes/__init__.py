# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Processes of the graph's nodes, one each or all in one: start, supervise and stop them."""
