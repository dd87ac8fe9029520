# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verdict of a run: its state, and its criteria compared with limits whose source is cited."""
