# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Models of the transmission that predictive controllers and their observers share."""
