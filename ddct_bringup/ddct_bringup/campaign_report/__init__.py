# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Analysis of a campaign: frequency, severity, location and causes of failed engagements."""
