# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What all exports of controllers as C have in common."""
