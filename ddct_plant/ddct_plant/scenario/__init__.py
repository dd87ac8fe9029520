# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scenarios: what a run consists of, read from files, with its initial state."""
