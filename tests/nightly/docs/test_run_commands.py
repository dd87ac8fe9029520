# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every documented run, comparison, design, study and report works."""

from pathlib import Path

import pytest
from support.documented import Block
from support.documented_commands import (
    SHELL_BLOCKS,
    commands_of,
    in_this_process,
    label,
    run_here,
)

BLOCKS = [block for block in SHELL_BLOCKS if in_this_process(block)]
_LEAVE_NOTHING = ('ddct thesis ', 'ddct design ')
"""First words of commands that read nothing that others write."""
DONE: set[str] = set()
"""Such commands that have been run, with another page."""


@pytest.mark.parametrize('block', BLOCKS, ids=label)
def test_commands_run(block: Block, shared_runs: Path) -> None:
    for line in commands_of(block):
        if line not in DONE or '--out' in line or '--export' in line:
            assert run_here(line) == 0, line
        if line.startswith(_LEAVE_NOTHING):
            DONE.add(line)
