# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Page, tables and folder of a tuning."""
