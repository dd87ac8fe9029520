# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Template of a package for a controller of one's own, as `check --new` writes it."""
