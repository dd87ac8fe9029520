# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Identification of driveline parameters, from printed transfer functions or a log."""
