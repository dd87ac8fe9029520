# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The engine of many runs: blocks of work, and the processes here or in a cluster that do it."""
