# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Helpers of the tests that cross packages."""
