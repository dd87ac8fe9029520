# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Damaged inputs for every reader of files and messages."""
