# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimators: states that are not measured, disturbances, wear."""
