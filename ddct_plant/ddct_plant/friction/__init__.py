# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline with dry friction: one clutch or two, and the wheels."""
