# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Description of a run in its bag, equal for every process layout, with the source commit."""

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from pathlib import Path

from ddct_bringup.bag.run_info import RunInfoOfNodes
from ddct_controllers.interface import Controller
from ddct_plant.base.timebase import time_of_step
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.graph.node_reports import node_info
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.recorded_settings import SETTINGS, RecordedSettings
from ddct_plant.scenario.settings import RunSettings

UNKNOWN = 'unknown'
DIRTY = '-dirty'
"""Suffix of the commit when a package differs from it by a changed, new or deleted file."""

_PACKAGES = 'ddct_*'
_TIMEOUT_S = 10.0


def custom_data(settings: RunSettings, controller: str, steps: int) -> dict[str, str]:
    """Return the bag's custom data: the settings of the run as one JSON, version and commit."""
    recorded = RecordedSettings.of(settings, controller, time_of_step(steps))
    return {SETTINGS: recorded.text(), 'version': package_version(), 'commit': source_commit()}


def run_info_of(
    settings: RunSettings, name: str, controller: Controller, steps: int
) -> RunInfoOfNodes:
    """Return the `run_info` that the nodes of a graph with these settings publish."""
    info = node_info(settings.known, controller.info(name), controller.preview_steps, steps)
    return {name_in_graph(node): pairs for node, pairs in info.items()}


_AS_OF: ContextVar[str | None] = ContextVar('_AS_OF', default=None)
"""Commit that stands for that of this process."""


@contextmanager
def as_of_commit(commit: str) -> Iterator[None]:
    """Let `source_commit` be another one of the same code, as a repeated run describes it."""
    token = _AS_OF.set(commit)
    try:
        yield
    finally:
        _AS_OF.reset(token)


def source_commit() -> str:
    """Return the commit of the sources of this process, or that of `as_of_commit`."""
    return _AS_OF.get() or _loaded_commit()


@cache
def _loaded_commit() -> str:
    """
    Return the `commit_of` the sources of this process, found at first use and then kept.

    The loaded code stays the same, whatever becomes of its files: in a long session a commit of
    later would name code that does not run. Forked processes inherit it with the code.
    """
    return commit_of(Path(__file__))


def commit_of(file: Path) -> str:
    """
    Return the git commit that contains `file`, a source module, with `DIRTY` where it applies.

    Return 'unknown' outside a checkout: for a copy inside another repository git would return
    the commit of that repository. Git is called twice, which takes 10 ms or more.
    """
    path = file.resolve()
    try:
        commit, _ = _git(path.parent, 'rev-parse', 'HEAD', f'HEAD:./{path.name}').split()
        changes = _git(path.parents[3], 'status', '--porcelain', '--', _PACKAGES)
    except (OSError, subprocess.SubprocessError):
        return UNKNOWN
    return commit + (DIRTY if changes else '')


def short_commit(commit: str) -> str:
    """Return a commit of `source_commit` shortened to a few letters, with its suffix."""
    name, mark, _ = commit.partition(DIRTY)
    return name[:10] + mark


def _git(folder: Path, *arguments: str) -> str:
    # Inside a git hook these variables name another repository.
    environment = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith('GIT_') or name.startswith('GIT_CONFIG')
    }
    return subprocess.run(
        ['git', '--no-optional-locks', *arguments],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=_TIMEOUT_S,
        check=True,
    ).stdout
