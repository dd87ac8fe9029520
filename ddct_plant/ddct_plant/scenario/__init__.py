# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scenarios: the parts of a run, read from files, with its initial state."""
