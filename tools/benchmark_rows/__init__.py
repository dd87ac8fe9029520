# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of the packaged controllers on the development cases, which are kept with a release."""
