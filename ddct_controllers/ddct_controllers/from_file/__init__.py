# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers in a file: one loader for each kind of YAML file, and one for Python."""
