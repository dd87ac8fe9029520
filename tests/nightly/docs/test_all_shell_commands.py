# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Documented commands that need a shell: graphs by hand, sourcing, compiling."""

from pathlib import Path

import pytest
from support.documented import Block
from support.documented_commands import SHELL_BLOCKS, commands_of, in_this_process, label
from support.documented_shell import run_block, shell_environment

BLOCKS = [block for block in SHELL_BLOCKS if commands_of(block) and not in_this_process(block)]


@pytest.mark.parametrize('block', BLOCKS, ids=label)
def test_commands_run(block: Block, workplace: Path, install: Path) -> None:
    run_block(block, workplace, shell_environment(workplace, install))
