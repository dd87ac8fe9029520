# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The documentation site: the pages of the repository and the reference, built by Sphinx."""
