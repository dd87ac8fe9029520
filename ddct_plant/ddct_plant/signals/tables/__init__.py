# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tables of topics by subject, and what their rows are made of."""
