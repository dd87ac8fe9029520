# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Functional mock-up units (FMU) as controllers: their files, variables and steps."""
