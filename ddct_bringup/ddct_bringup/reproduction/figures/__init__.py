# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of the thesis that can be computed, by number, and the gallery that shows them."""
