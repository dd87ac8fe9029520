# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The base commit is a worktree that is gone when the bench ends, however it ends."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from bench.skeleton.base_commit import PREFIX, base_workspace, commit_of
from bench.skeleton.workspace import ProgramError
from support.processes import Programs
from support.waiting import wait_until

TESTS = Path(__file__).resolve().parents[1]
MAKEFILE = """\
setup:
\t@mkdir -p install && echo 'export OF_THE_BASE=yes' > install/setup.sh
"""
SLOW = 'setup:\n\tsleep 300 & echo $$! > $(MARK); wait\n'
DRIVER = """\
import sys
from pathlib import Path
from bench.skeleton.base_commit import base_workspace
from bench.skeleton.interruption import interrupt_once
interrupt_once()
try:
    with base_workspace('HEAD', Path(sys.argv[1])) as workspace:
        workspace.run('sh', '-c', f'sleep 300 & echo $! > {sys.argv[2]}; wait')
except KeyboardInterrupt:
    sys.exit(130)
"""


def _git(repository: Path, *arguments: str) -> str:
    identity = ['-c', 'user.name=a', '-c', 'user.email=a@b.c']
    command = ['git', '-C', str(repository), *identity, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a repository with two commits; worktrees are made in the folder beside it."""
    monkeypatch.setenv('TMPDIR', str(tmp_path / 'temporary'))
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path / 'temporary'))
    (tmp_path / 'temporary').mkdir()
    root = tmp_path / 'repository'
    root.mkdir()
    _git(root, 'init', '--quiet')
    for text in ('first', 'second'):
        (root / 'text').write_text(text)
        (root / 'Makefile').write_text(MAKEFILE)
        _git(root, 'add', '.')
        _git(root, 'commit', '--quiet', '-m', text)
    return root


def _left(repository: Path) -> list[str]:
    """Return the worktrees beside the repository's own, and the temporary folders."""
    worktrees = _git(repository, 'worktree', 'list').splitlines()[1:]
    return worktrees + [path.name for path in (repository.parent / 'temporary').iterdir()]


def _has_ended(pid: int) -> bool:
    """Return whether a process has ended; its parent may be slow to wait for it."""
    try:
        stat = Path('/proc', str(pid), 'stat').read_text(encoding='utf-8')
    except OSError:
        return True
    return stat.rpartition(')')[2].split()[0] in 'ZX'


def test_the_base_is_set_up_in_a_worktree_that_is_removed(repository: Path) -> None:
    with base_workspace('HEAD~1', repository) as workspace:
        assert (workspace.folder / 'text').read_text() == 'first'
        assert workspace.environment['OF_THE_BASE'] == 'yes'
        assert workspace.run('sh', '-c', 'cat text').output == 'first'
        assert len(_left(repository)) == 2
    assert _left(repository) == []


def test_no_variable_of_this_workspace_reaches_the_base(
    repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ('PYTHONPATH', 'AMENT_PREFIX_PATH', 'MAKEFLAGS', 'LD_LIBRARY_PATH'):
        monkeypatch.setenv(name, '/ours')
    with base_workspace('HEAD', repository) as workspace:
        assert '/ours' not in workspace.environment.values()


def test_a_set_up_that_fails_leaves_nothing_and_gives_its_reason(repository: Path) -> None:
    (repository / 'Makefile').write_text('setup:\n\t@echo no compiler >&2; exit 1\n')
    _git(repository, 'commit', '--quiet', '-a', '-m', 'broken')
    with (
        pytest.raises(ProgramError, match='make setup ended with code 2'),
        base_workspace('HEAD', repository),
    ):
        pass
    assert _left(repository) == []


def test_an_unknown_revision_is_one_line(repository: Path) -> None:
    with pytest.raises(SystemExit, match='^bench: BASE: git knows no commit nothing: .*$'):
        commit_of('nothing', repository)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize('during', ['set-up', 'measurement'])
def test_an_interrupted_bench_leaves_no_worktree_and_no_process(
    repository: Path, tmp_path: Path, programs: Programs, during: str, number: signal.Signals
) -> None:
    mark = tmp_path / 'process'
    if during == 'set-up':
        (repository / 'Makefile').write_text(SLOW.replace('$(MARK)', str(mark)))
        _git(repository, 'commit', '--quiet', '-a', '-m', 'slow')
    bench = programs.start(
        [sys.executable, '-c', DRIVER, str(repository), str(mark)],
        env={**os.environ, 'PYTHONPATH': str(TESTS)},
    )
    wait_until(lambda: mark.exists() and mark.read_text().endswith('\n'), 'the program')
    process = int(mark.read_text())
    bench.send(number)
    assert bench.wait() == 130
    wait_until(lambda: _has_ended(process), 'its end')
    assert _left(repository) == []


def test_the_worktree_of_a_killed_bench_is_removed_by_the_next_one(repository: Path) -> None:
    ended = subprocess.Popen(['true'])
    ended.wait()
    place = repository.parent / 'temporary' / f'{PREFIX}{ended.pid}-x'
    other = repository.parent / 'temporary' / f'{PREFIX}{os.getpid()}-x'
    for each in (place, other):
        _git(repository, 'worktree', 'add', '--quiet', '--detach', str(each / 'base'), 'HEAD')
    with base_workspace('HEAD', repository):
        assert not place.exists()
        assert (other / 'base' / 'text').exists()
