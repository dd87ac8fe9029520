# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every documented run, comparison and report works."""

from pathlib import Path

import pytest
from documented_commands import (
    SHELL_BLOCKS,
    commands_of,
    in_this_process,
    is_design,
    label,
    run_here,
)
from support.documented import Block

pytestmark = pytest.mark.slow

BLOCKS = [block for block in SHELL_BLOCKS if in_this_process(block) and not is_design(block)]


DONE: set[str] = set()
"""Commands of `reproduce` that have been run: they read nothing that others write, or leave."""


@pytest.mark.parametrize('block', BLOCKS, ids=label)
def test_commands_run(block: Block, shared_runs: Path) -> None:
    for line in commands_of(block):
        if line not in DONE:
            assert run_here(line) == 0, line
        if line.startswith('ddct reproduce '):
            DONE.add(line)
