# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers after the works that the thesis cites as the state of the art (Section 1.3)."""
