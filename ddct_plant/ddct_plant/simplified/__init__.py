# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The simplified plants of Section 1.5.1."""
