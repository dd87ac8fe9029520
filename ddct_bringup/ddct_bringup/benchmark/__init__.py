# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The benchmark: fixed development cases, held-out cases, and what a controller does in both."""
