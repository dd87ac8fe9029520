# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Reading the parts of a specification of campaigns: every mistake names its key."""
