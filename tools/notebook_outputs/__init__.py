# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The notebooks of the documentation, executed and kept with their outputs."""
