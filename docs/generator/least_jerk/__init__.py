# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the page of `least_jerk`."""
