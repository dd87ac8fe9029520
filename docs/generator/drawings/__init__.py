# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Block diagrams, and the charts of studies."""
