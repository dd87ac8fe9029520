# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Recorder: the node that writes the topics of the graph into a bag."""
