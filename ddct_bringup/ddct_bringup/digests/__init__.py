# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Digests of results: of files, code, versions and the kind of processor."""
