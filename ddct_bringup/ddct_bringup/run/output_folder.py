"""Output folders: held by one program, never half a result, never others' files overwritten."""

import errno
import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Self

from ddct_plant.base.errors import DdctError

MARKER = '.ddct-output'
"""Marks a folder as written by these programs, so that `--overwrite` may replace it."""
PARTIAL = '.partial'
"""Ends the name of a folder that is not complete yet."""
SUFFIX = '.ddct-lock'
"""The lock of DIR is the file .DIR.ddct-lock beside it, which is there only while it is held."""
_MARKER_TEXT = 'Written by ddct_bringup; --overwrite may replace this folder.\n'
_NO_PLACE = (errno.EACCES, errno.EPERM, errno.EROFS)


class StagedFolder:
    """
    A folder that appears under its final name only when it is complete.

    Work goes to `<final>.partial` beside it. `commit` puts it in place of an earlier result, which
    stays untouched until then; after a failure the partial folder is left for inspection, and
    `with` adds its name to an interruption. Whoever uses it holds the final folder (`held`).
    """

    def __init__(self, final: Path, *, overwrite: bool) -> None:
        """Create the partial folder; raise DdctError where something is in the way."""
        self.final = final
        self.path = final.with_name(f'{final.name}{PARTIAL}')
        self._overwrite = overwrite
        self._require_free(final, 'choose another --out or add --overwrite')
        require_ours_or_empty(self.path)
        if not overwrite and any(self.path.rglob('*.mcap')):
            raise DdctError(
                f'{self.path} holds what an interrupted run left: rescue it with '
                '`ddct score --repair`, then remove it or add --overwrite'
            )
        with _refused(self.path, 'written'):
            if self.path.exists():
                shutil.rmtree(self.path)
        mark_folder(self.path)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        """Raise KeyboardInterrupt anew, with what there is and where, after an interruption."""
        if kind is not None and issubclass(kind, KeyboardInterrupt):
            raise KeyboardInterrupt(f'interrupted: {self.left}')

    @property
    def left(self) -> str:
        """Say for a message what a run that was not committed has left, and where."""
        return f'{self.final} is untouched, what was recorded is in {self.path}'

    def commit(self) -> None:
        """Move the partial folder to its final name; raise DdctError when that fails."""
        self._require_free(self.final, 'it came while this run took place')
        with _refused(self.final, 'replaced'):
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
    """Raise DdctError when `folder` holds anything that these programs did not write."""
    if folder.is_symlink():
        raise DdctError(f'{folder} is a symbolic link: give the folder itself, or another --out')
    if folder.exists() and not folder.is_dir():
        raise DdctError(f'{folder} is not a folder: choose another --out')
    if not is_empty(folder) and not (folder / MARKER).is_file():
        raise DdctError(
            f'{folder} holds files that are not ours (no {MARKER} in it): choose another --out'
        )


def is_empty(folder: Path) -> bool:
    """Say whether the folder is absent or has nothing in it."""
    with _refused(folder, 'read'):
        return not folder.exists() or not any(folder.iterdir())


def mark_folder(folder: Path) -> None:
    """Create `folder` as ours when it is absent or empty; raise DdctError otherwise."""
    require_ours_or_empty(folder)
    with _refused(folder, 'written'):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / MARKER).write_text(_MARKER_TEXT, encoding='utf-8')


@contextmanager
def _refused(folder: Path, what: str) -> Iterator[None]:
    """Raise DdctError for what the operating system refuses to do with a folder."""
    try:
        yield
    except OSError as error:
        raise DdctError(f'{folder}: cannot be {what} ({error.strerror})') from error


@contextmanager
def held(*folders: Path, shared: bool = False) -> Iterator[None]:
    """
    Hold `folders`, and what is in them, while this program writes there.

    `shared` lets others hold them that way too, to write into folders of their own below. The
    folders of ours around them are held so in any case. A folder and its partial one are the same.
    The locks are the operating system's: they end with the process, however it ends.
    Raise DdctError that names the folder and the process that holds it.
    """
    own = {_final(folder) for folder in folders}
    around = {parent for folder in own for parent in folder.parents if is_ours(parent)} - own
    with ExitStack() as locks:
        for folder in sorted(own | around):
            locks.enter_context(_lock(folder, shared or folder in around))
        yield


@contextmanager
def run_folder(out: Path, name: str, *, overwrite: bool) -> Iterator[StagedFolder]:
    """Hold the folder `name` in `out`, which is made if absent, and yield it staged."""
    with held(out, shared=True):
        mark_folder(out)
        with held(out / name), StagedFolder(out / name, overwrite=overwrite) as folder:
            yield folder


def is_ours(folder: Path) -> bool:
    """Say whether these programs wrote the folder."""
    with suppress(OSError):
        return (folder / MARKER).is_file()
    return False


def _final(folder: Path) -> Path:
    path = Path(os.path.realpath(folder))
    return path.parent / (path.name.removesuffix(PARTIAL) or path.name)


@contextmanager
def _lock(folder: Path, shared: bool) -> Iterator[None]:
    file = folder.parent / f'.{folder.name}{SUFFIX}'
    try:
        descriptor = _locked(file, shared)
    except BlockingIOError:
        raise DdctError(
            f'{folder}: {_holder(file)} is writing there: wait for its end or give another folder'
        ) from None
    except OSError as error:
        if error.errno not in _NO_PLACE:
            raise DdctError(f'{folder}: cannot be written ({error.strerror})') from error
        yield  # nobody can make or replace the folder either
        return
    try:
        yield
    finally:
        with suppress(OSError):
            # Of those who share a lock the last one removes it.
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            file.unlink()
        os.close(descriptor)


def _locked(file: Path, shared: bool) -> int:
    """Return the open lock file; raise BlockingIOError when another holds it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    kind = fcntl.LOCK_SH if shared else fcntl.LOCK_EX
    while True:
        descriptor = os.open(file, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_NOFOLLOW, 0o666)
        try:
            fcntl.flock(descriptor, kind | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(descriptor), file.stat()):
                with suppress(OSError):  # a full disk; the number is only for the message
                    os.write(descriptor, f'{os.getpid()}\n'.encode())
                return descriptor
        except FileNotFoundError:
            pass  # removed by whoever held it, between our two steps
        except OSError:
            os.close(descriptor)
            raise
        os.close(descriptor)


def _holder(file: Path) -> str:
    """Return the name of the living processes that have written their number into the file."""
    with suppress(OSError, ValueError):
        numbers = dict.fromkeys(int(line) for line in file.read_text().split())
        alive = [str(number) for number in numbers if Path('/proc', str(number)).exists()]
        if alive:
            return f'process {" and ".join(alive)}'
    return 'another process'
