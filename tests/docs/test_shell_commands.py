# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A documented command that needs a shell runs; `tests/nightly/docs` has all of them."""

from pathlib import Path

import pytest
from support.documented_commands import SHELL_BLOCKS, commands_of
from support.documented_shell import run_block, shell_environment


@pytest.mark.slow
def test_a_campaign_and_its_report_run_as_documented(workplace: Path, install: Path) -> None:
    (block,) = [
        block for block in SHELL_BLOCKS if 'ddct campaign show' in '\n'.join(commands_of(block))
    ]
    run_block(block, workplace, shell_environment(workplace, install))
