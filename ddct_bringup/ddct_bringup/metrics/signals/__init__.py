# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Mathematics of sampled signals: filters, integrals, means and vibration."""
