"""Which commit of our sources runs."""

import os
import subprocess
from pathlib import Path

UNKNOWN = 'unknown'
DIRTY = '-dirty'
"""Follows the commit when a package differs from it, by a changed, new or deleted file."""

_PACKAGES = 'ddct_*'
_TIMEOUT_S = 10.0


def source_commit(file: Path = Path(__file__)) -> str:
    """
    Return the git commit that holds `file`, a module like this one, with `DIRTY` where due.

    'unknown' outside a checkout: of a copy that lies in somebody else's repository git would name
    that one's commit. It takes two calls of git, about 10 ms.
    """
    path = file.resolve()
    try:
        commit, _ = _git(path.parent, 'rev-parse', 'HEAD', f'HEAD:./{path.name}').split()
        changes = _git(path.parents[3], 'status', '--porcelain', '--', _PACKAGES)
    except (OSError, subprocess.SubprocessError):
        return UNKNOWN
    return commit + (DIRTY if changes else '')


def short_commit(commit: str) -> str:
    """Return a commit as `source_commit` names it in few letters, its mark included."""
    name, mark, _ = commit.partition(DIRTY)
    return name[:10] + mark


def _git(folder: Path, *arguments: str) -> str:
    # In a hook of git these variables name another repository.
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
