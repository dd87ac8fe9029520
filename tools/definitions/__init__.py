# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Definitions of message types: run `python -m definitions`."""
