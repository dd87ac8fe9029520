# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Documented commands run: those of each program once, and every run can be planned.

`tests/nightly/docs` runs all of them.
"""

import shlex
import shutil
from pathlib import Path
from typing import NoReturn

import pytest
from support.documented import Block, blocks
from support.documented_commands import (
    NOT_RUN_HERE,
    SHELL_BLOCKS,
    commands_of,
    in_this_process,
    label,
    run_here,
    sample_of,
)

from ddct_bringup.api import shell

BLOCKS = [block for block in SHELL_BLOCKS if in_this_process(block)]
SAMPLE = sample_of(BLOCKS)
RUNS = 'ddct compare --'


@pytest.mark.usefixtures('no_page')
@pytest.mark.parametrize('block', SAMPLE, ids=label)
def test_each_program_runs_as_a_page_shows(block: Block, shared_runs: Path) -> None:
    """The report that they end with is drawn in tests/report and ddct_bringup/test/report."""
    for line in commands_of(block):
        assert run_here(line) == 0, line


class OnlyPlannedError(Exception):
    """The plan of a run is made, and nothing is simulated."""


def _planned(*_: object, **__: object) -> NoReturn:
    raise OnlyPlannedError


@pytest.mark.slow
def test_every_documented_run_can_be_planned(
    shared_runs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    Its options, keys, controllers and scenario are there; only files that others make not.

    Lines with names in ROS need the graph: `tests/nightly/docs` runs them.
    """
    for name in ('keep_run', 'compare_into'):
        monkeypatch.setattr(shell, name, _planned)
    lines = {
        line
        for block in SHELL_BLOCKS
        if block not in SAMPLE
        for line in commands_of(block)
        if line.startswith(RUNS) and '--out' in line and '--ros-args' not in line
        if not _needs_a_made_file(line, shared_runs)
    }
    assert len(lines) > 20
    for line in sorted(lines):
        with pytest.raises(OnlyPlannedError):
            run_here(line)
        shutil.rmtree('runs', ignore_errors=True)


def _needs_a_made_file(line: str, folder: Path) -> bool:
    names = [name for word in shlex.split(line) for name in word.split(',')]
    files = [name for name in names if name.endswith(('.yaml', '.py'))]
    return any(not (folder / name).is_file() for name in files)


def test_every_reason_not_to_run_a_command_is_of_a_command_on_a_page() -> None:
    lines = [line for block in SHELL_BLOCKS for line in block.lines]
    unused = [words for words in NOT_RUN_HERE if not any(each.startswith(words) for each in lines)]
    assert unused == []


def test_commands_in_shell_blocks_begin_with_ddct_or_a_path() -> None:
    """A bare program name works in no shell, and would slip through these tests."""
    names = {'compare', 'score', 'report', 'live', 'thesis', 'design', 'identify'}
    bare = [
        (block.page, line)
        for block in blocks()
        for line in block.lines
        if line.split()[0] in names and block.language == ''
    ]
    assert bare == []
    assert {block.page for block in SHELL_BLOCKS} >= {'README.md', 'docs/controllers/mpc.md'}
