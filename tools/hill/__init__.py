# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The least jerk of `launch_hill` in sets of runs that are larger than its own."""
