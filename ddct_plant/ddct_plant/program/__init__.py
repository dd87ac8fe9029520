# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Common parts of all programs: errors, tables, progress, signals, worker processes."""
