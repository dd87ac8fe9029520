# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Live view of the graph in Foxglove: a WebSocket server and the node that feeds it."""
