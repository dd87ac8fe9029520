# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The generalised plant, the Riccati and LMI solutions, and the norm that accepts them."""
