# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The least that any controller could do: lower bounds of metrics, certified, and replayed."""
