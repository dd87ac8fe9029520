# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The slipping and the locked plant as exact affine functions of the torque requests."""
