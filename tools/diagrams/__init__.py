# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The diagrams of the pages, drawn as SVG."""
