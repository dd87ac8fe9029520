# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The speed as a few ratios: to peers, and to another commit."""
