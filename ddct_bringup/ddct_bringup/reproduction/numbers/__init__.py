# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Thesis gate: comparison of every number and claim of the thesis with a computed one."""
