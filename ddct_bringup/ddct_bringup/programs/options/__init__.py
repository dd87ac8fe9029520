# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Options of the programs, and their values as arguments of the Python interface."""
