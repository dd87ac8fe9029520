# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Documents of tables, charts and notes, for the terminal and as pages."""
