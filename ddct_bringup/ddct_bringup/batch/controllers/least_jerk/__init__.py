# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controller `least_jerk` of many runs: each class is the counterpart of a single one."""
