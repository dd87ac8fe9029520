# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Processes in which a third party's compiled code runs: C libraries and FMUs."""
