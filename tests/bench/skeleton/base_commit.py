# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The base commit as a workspace: a worktree in a temporary folder, built, removed at the end."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bench.skeleton.interruption import uninterrupted
from bench.skeleton.workspace import ROOT, Workspace, clean_environment, run_to_end

PREFIX = 'ddct-bench-'
"""Prefix of the temporary folder; the id of the process that makes it follows."""


@contextmanager
def base_workspace(revision: str, root: Path = ROOT) -> Iterator[Workspace]:
    """
    Check out a revision, run `make setup` there, and yield the workspace.

    The worktree is removed at the end, also where we are interrupted. Exit with one line where git
    does not know the revision; raise ProgramError where the set-up fails.
    """
    commit = commit_of(revision, root)
    _remove_abandoned(root)
    place = Path()
    try:
        with uninterrupted():
            place = Path(tempfile.mkdtemp(prefix=f'{PREFIX}{os.getpid()}-'))
            folder = place / 'base'
            _git(root, 'worktree', 'add', '--quiet', '--detach', str(folder), commit)
        print(f'bench: sets up the base commit {commit[:10]}', file=sys.stderr, flush=True)
        run_to_end(['make', 'setup'], folder, clean_environment())
        yield Workspace(folder)
    finally:
        if place.name:
            _remove(root, place)


def commit_of(revision: str, root: Path = ROOT) -> str:
    """Return the full id of a commit; exit with one line where git does not know the revision."""
    try:
        return _git(root, 'rev-parse', '--verify', '--quiet', f'{revision}^{{commit}}').strip()
    except (OSError, subprocess.CalledProcessError):
        sys.exit(f'bench: BASE: git knows no commit {revision}: give one of `git log --oneline`')


def _remove(root: Path, place: Path) -> None:
    shutil.rmtree(place, ignore_errors=True)
    _git(root, 'worktree', 'prune')


def _remove_abandoned(root: Path) -> None:
    """Remove the worktrees of benches that were killed and could not remove theirs."""
    for line in _git(root, 'worktree', 'list', '--porcelain').splitlines():
        place = Path(line.removeprefix('worktree ')).parent
        found = re.fullmatch(rf'{PREFIX}(\d+)-\w+', place.name)
        if found and not Path('/proc', found[1]).exists():
            _remove(root, place)


def _git(root: Path, *arguments: str) -> str:
    done = subprocess.run(
        ['git', '-C', str(root), *arguments], check=True, capture_output=True, text=True
    )
    return done.stdout
