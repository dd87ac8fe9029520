# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Clutch controllers, their interface and their registry."""
