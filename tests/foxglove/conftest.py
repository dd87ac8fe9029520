# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bags of short runs, as the layout is checked against them."""

from collections.abc import Callable
from pathlib import Path

import pytest
from support.foxglove_layout import Messages, read_messages

from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan


@pytest.fixture
def record(tmp_path: Path) -> Callable[[RunPlan], Messages]:
    """Return a function that carries out a run and returns what its bag holds."""

    def carry_out(run: RunPlan) -> Messages:
        folder = tmp_path / 'bag'
        folder.mkdir()
        execute(run, folder)
        return read_messages(folder)

    return carry_out
