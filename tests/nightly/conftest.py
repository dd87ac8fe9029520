# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Tests of `make test-nightly`, which `make test` leaves out.

They depend on the wall clock, try whole gates of thousands of cases, or products of lists.
"""
