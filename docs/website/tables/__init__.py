# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of what the code declares or computes, made when the site is built."""
