# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The manifest of a result: its inputs, plan, code, environment, and the digest of each file."""
