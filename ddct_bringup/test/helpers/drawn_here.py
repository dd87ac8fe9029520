# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Pages of `compare` that are drawn in the process of the tests, which has the libraries."""

from contextlib import nullcontext

import pytest

from ddct_bringup.api.shell import comparison
from ddct_bringup.api.shell.pages import draw_page


def draw_here(patch: pytest.MonkeyPatch) -> None:
    """Let `compare` start no process that imports what draws; test_drawn_apart.py has that one."""
    patch.setattr(comparison, 'drawn_apart', lambda: nullcontext(draw_page))
