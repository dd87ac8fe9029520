# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A scenario is a car, a drive and a few changed keys: which key belongs to which, and files."""
