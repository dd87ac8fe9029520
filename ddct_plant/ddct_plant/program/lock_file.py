# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lock files by `portalocker`: each exists while a process uses the file or folder it is for."""

import errno
import os
from contextlib import suppress
from pathlib import Path
from typing import Self
from weakref import WeakSet

from ddct_plant.program.operating_system import open_files_stay


class LockFile:
    """
    A file that this process has locked, alone or, as `shared`, with others.

    The lock is the operating system's: it ends with the process, however that ends. A fork does
    not have it. The last one that has it removes the file.
    """

    def __init__(self, path: Path, *, shared: bool = False) -> None:
        """Lock a file; raise BlockingIOError where another has it, OSError without a place."""
        self.path = path
        self._descriptor: int | None = _locked(path, shared=shared)
        _taken.add(self)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def leave(self) -> None:
        """Let go of the file in a fork: the lock stays that of the process which was forked."""
        descriptor, self._descriptor = self._descriptor, None
        if descriptor is not None:
            os.close(descriptor)

    def release(self) -> None:
        """Give the lock back; nothing happens where it was given back."""
        descriptor, self._descriptor = self._descriptor, None
        if descriptor is None:
            return
        if open_files_stay():
            os.close(descriptor)
            with suppress(OSError):  # another process has opened it
                self.path.unlink()
            return
        with suppress(OSError):  # another process has locked it too
            _lock(descriptor, shared=False)
            self.path.unlink()
        os.close(descriptor)


_taken: WeakSet[LockFile] = WeakSet()


def _leave_all() -> None:
    for lock in [*_taken]:
        lock.leave()


if hasattr(os, 'register_at_fork'):
    # Else a fork that outlives a killed program for a moment would keep its locks.
    os.register_at_fork(after_in_child=_leave_all)


def _locked(path: Path, *, shared: bool) -> int:
    """Open and lock a file; return its descriptor."""
    path.parent.mkdir(parents=True, exist_ok=True)
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            _lock(descriptor, shared=shared)
            if os.path.samestat(os.fstat(descriptor), path.stat()):
                # A full disk, or Windows, where a locked file is not written to: the process id
                # is only for the message.
                with suppress(OSError):
                    os.write(descriptor, f'{os.getpid()}\n'.encode())
                return descriptor
        except FileNotFoundError:
            pass  # removed by its owner between the two steps above
        except OSError:
            os.close(descriptor)
            raise
        os.close(descriptor)


def _lock(descriptor: int, *, shared: bool) -> None:
    """Lock an open file now; raise BlockingIOError where another has it, or another OSError."""
    import portalocker  # late: slower to import than a lock takes

    kind = portalocker.LockFlags.SHARED if shared else portalocker.LockFlags.EXCLUSIVE
    try:
        portalocker.lock(descriptor, kind | portalocker.LockFlags.NON_BLOCKING)
    except portalocker.AlreadyLocked as error:
        raise BlockingIOError(errno.EAGAIN, 'locked by another') from error
    except portalocker.LockException as error:
        why = error.__cause__
        raise (why if isinstance(why, OSError) else OSError(errno.ENOLCK, str(error))) from None
