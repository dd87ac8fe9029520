# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables and diagrams of the pages, which `make docs` writes."""
