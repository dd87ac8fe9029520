# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Random mutations of the product, tried against the suite."""
