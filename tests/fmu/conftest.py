# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Common parts of the tests of FMUs."""

from support.fmu import folder

__all__ = ['folder']
