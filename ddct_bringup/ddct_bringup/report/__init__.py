# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page that `report` writes: its content and its layout."""
