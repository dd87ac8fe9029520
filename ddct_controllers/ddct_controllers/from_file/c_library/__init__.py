# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers written in C: the interface of the shared library, and its calls."""
