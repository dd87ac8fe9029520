# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A gear shift with two clutches: gears, driveline with three friction elements, initial state."""
