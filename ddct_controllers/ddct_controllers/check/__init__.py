# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Conformance check of a controller: the trials and checks of `ddct check`."""
