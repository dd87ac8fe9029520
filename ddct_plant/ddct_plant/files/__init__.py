# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read and write files of users: CSV, YAML and JSON, written completely or not at all."""
