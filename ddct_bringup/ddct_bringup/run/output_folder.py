# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Output folders: locked by one program, complete or absent, never over files of others."""

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Self

from ddct_plant.base.errors import DdctError
from ddct_plant.program.lock_file import LockFile
from ddct_plant.program.operating_system import is_running

MARKER = '.ddct-output'
"""Name of the file that marks a folder of these programs, which `--overwrite` may replace."""
PARTIAL = '.partial'
"""Suffix of the name of a folder that is not complete yet."""
SUFFIX = '.ddct-lock'
"""
Suffix of the lock file of DIR, .DIR.ddct-lock beside it, which exists only while DIR is locked.
"""
_MARKER_TEXT = 'Written by ddct_bringup; --overwrite may replace this folder.\n'
_NO_PLACE = (errno.EACCES, errno.EPERM, errno.EROFS)


class StagedFolder:
    """
    Folder that appears under its final name only when it is complete.

    Files go to `<final>.partial` beside it. `commit` puts it in place of an earlier result,
    which stays untouched until then; after a failure the partial folder is left for
    inspection, and `with` adds its name to an interruption. Its users lock the final folder
    (`locked_folders`).
    """

    def __init__(self, final: Path, *, overwrite: bool) -> None:
        """Create the partial folder; raise DdctError where other files are in the way."""
        self.final = final
        self.path = final.with_name(f'{final.name}{PARTIAL}')
        self._overwrite = overwrite
        self._require_free(final, 'choose another --out or add --overwrite')
        require_ours_or_empty(self.path)
        if not overwrite and any(self.path.rglob('*.mcap')):
            raise DdctError(
                f'{self.path} holds what an interrupted run left: remove it or add --overwrite '
                '(`ddct score` and `ddct report` show it)'
            )
        with _io_errors_named(self.path, 'written'):
            if self.path.exists():
                shutil.rmtree(self.path)
        mark_folder(self.path)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        """Raise KeyboardInterrupt anew after an interruption, with the state of the folders."""
        if kind is not None and issubclass(kind, KeyboardInterrupt):
            raise KeyboardInterrupt(f'interrupted: {self.left}')

    @property
    def left(self) -> str:
        """Text for a message: the files that a run without commit has left, and their folder."""
        return f'nothing was written to {self.final}, what was recorded is in {self.path}'

    def commit(self) -> None:
        """Move the partial folder to its final name; raise DdctError when that fails."""
        self._require_free(self.final, 'it came while this run took place')
        with _io_errors_named(self.final, 'replaced'):
            aside = Path(tempfile.mkdtemp(prefix=f'.{self.final.name}-', dir=self.final.parent))
            replaced = aside / self.final.name
            if self.final.exists():
                self.final.rename(replaced)
            try:
                self.path.rename(self.final)
            except OSError:
                if replaced.exists():
                    replaced.rename(self.final)
                aside.rmdir()
                raise
            shutil.rmtree(aside)

    def _require_free(self, folder: Path, advice: str) -> None:
        require_ours_or_empty(folder)
        if not is_empty(folder) and not self._overwrite:
            raise DdctError(f'{folder} already holds a result: {advice}')


def require_ours_or_empty(folder: Path) -> None:
    """Raise DdctError when `folder` contains files that these programs did not write."""
    if folder.is_symlink():
        raise DdctError(
            f'{folder} is a symbolic link: give the folder itself, or another --out', key='--out'
        )
    if folder.exists() and not folder.is_dir():
        raise DdctError(f'{folder} is not a folder: choose another --out', key='--out')
    if not is_empty(folder) and not is_ours(folder):
        raise DdctError(
            f'{folder} holds files that are not ours (no {MARKER} in it): choose another --out',
            key='--out',
        )


def is_empty(folder: Path) -> bool:
    """Return whether the folder is absent or empty."""
    with _io_errors_named(folder, 'read'):
        return not folder.exists() or not any(folder.iterdir())


def mark_folder(folder: Path) -> None:
    """Create `folder` with the marker when it is absent or empty; raise DdctError otherwise."""
    require_ours_or_empty(folder)
    with _io_errors_named(folder, 'written'):
        folder.mkdir(parents=True, exist_ok=True)
        # Not over one that is there: as a link it may be any file.
        with suppress(FileExistsError), (folder / MARKER).open('x', encoding='utf-8') as marker:
            marker.write(_MARKER_TEXT)


@contextmanager
def _io_errors_named(folder: Path, what: str) -> Iterator[None]:
    """Raise DdctError where the operating system refuses to read or write a folder."""
    try:
        yield
    except OSError as error:
        raise DdctError(f'cannot be {what} ({error.strerror})', place=folder) from error


@contextmanager
def locked_folders(*folders: Path, shared: bool = False) -> Iterator[None]:
    """
    Lock `folders`, and everything in them, while this program writes there.

    With `shared`, other programs can lock them as shared too, to write into folders of their
    own below. Marked folders around them are locked as shared in any case. A folder and its
    partial one have the same lock. The locks are the operating system's: they end with the
    process, however it ends. Raise DdctError that names the folder and the process that has
    locked it.
    """
    own = {_final(folder) for folder in folders}
    around = {parent for folder in own for parent in folder.parents if is_ours(parent)} - own
    with ExitStack() as locks:
        for folder in sorted(own | around):
            locks.enter_context(_lock(folder, shared or folder in around))
        yield


@contextmanager
def run_folder(out: Path, name: str, *, overwrite: bool) -> Iterator[StagedFolder]:
    """Lock the folder `name` in `out`, which is created if absent, and yield it staged."""
    with locked_folders(out, shared=True):
        mark_folder(out)
        with locked_folders(out / name), StagedFolder(out / name, overwrite=overwrite) as folder:
            yield folder


def is_ours(folder: Path) -> bool:
    """Return whether these programs wrote the folder; they make no symbolic links."""
    with suppress(OSError):
        return stat.S_ISREG((folder / MARKER).lstat().st_mode)
    return False


def _final(folder: Path) -> Path:
    path = Path(os.path.realpath(folder))
    return path.parent / (path.name.removesuffix(PARTIAL) or path.name)


@contextmanager
def _lock(folder: Path, shared: bool) -> Iterator[None]:
    file = folder.parent / f'.{folder.name}{SUFFIX}'
    try:
        lock = LockFile(file, shared=shared)
    except BlockingIOError:
        raise DdctError(
            f'{_owner(file)} is writing there: wait for its end or give another folder',
            place=folder,
        ) from None
    except OSError as error:
        if error.errno not in _NO_PLACE:
            raise DdctError(f'{folder}: cannot be written ({error.strerror})') from error
        yield  # no other program can create or replace the folder either
        return
    with lock:
        yield


def _owner(file: Path) -> str:
    """Return the text "process ID" of the living processes whose ids are in the lock file."""
    with suppress(OSError, ValueError):  # Windows lets nobody else read a locked file
        numbers = dict.fromkeys(int(line) for line in file.read_text(encoding='ascii').split())
        alive = [str(number) for number in numbers if is_running(number)]
        if alive:
            return f'process {" and ".join(alive)}'
    return 'another process'
