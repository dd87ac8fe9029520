# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The fit behind the scenario `thesis`, made again."""
