"""Keep two programs from writing one run folder at the same time."""

import errno
import fcntl
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from ddct_bringup.run.output_folder import MARKER, PARTIAL, StagedFolder, mark_folder
from ddct_plant.base.errors import DdctError

SUFFIX = '.ddct-lock'
"""The lock of DIR is the file .DIR.ddct-lock beside it, which is there only while it is held."""
_NO_PLACE = (errno.EACCES, errno.EPERM, errno.EROFS)


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
        with held(out / name):
            yield StagedFolder(out / name, overwrite=overwrite)


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
