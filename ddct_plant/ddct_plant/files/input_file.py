"""Read files that a user names: regular ones only, and no more than fits into memory."""

import errno
import os
import stat
from pathlib import Path

from ddct_plant.base.errors import DdctError

MOST_TEXT_BYTES = 1_000_000
"""Largest scenario, controller or page that is read: hundreds of times their usual size."""
_KINDS = {
    stat.S_IFDIR: 'a folder',
    stat.S_IFIFO: 'a pipe',
    stat.S_IFCHR: 'a device',
    stat.S_IFBLK: 'a device',
    stat.S_IFSOCK: 'a socket',
}


def read_file(path: Path, most_bytes: int) -> bytes:
    """
    Return what a regular file holds.

    Raise OSError, whose `strerror` is fit for a user, when it cannot be read, is something else
    (a pipe would be waited for, a device may never end) or holds more than `most_bytes`.
    """
    # Without O_NONBLOCK it is the opening of a pipe that waits.
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    status = os.fstat(descriptor)
    kind = stat.S_IFMT(status.st_mode)
    if kind != stat.S_IFREG:
        os.close(descriptor)
        what = _KINDS.get(kind, 'no file')
        raise OSError(errno.EINVAL, f'it is {what}: give a regular file', str(path))
    with os.fdopen(descriptor, 'rb') as file:
        # Some files of the system say that they are empty and are not.
        data = file.read(most_bytes + 1) if status.st_size <= most_bytes else b''
    if max(len(data), status.st_size) > most_bytes:
        raise OSError(errno.EFBIG, f'it is larger than {most_bytes} bytes', str(path))
    return data


def read_text_file(path: Path, most_bytes: int = MOST_TEXT_BYTES) -> str:
    """Return the UTF-8 text of a file as `read_file` does; OSError too when it is none."""
    try:
        return read_file(path, most_bytes).decode('utf-8')
    except UnicodeDecodeError as error:
        raise OSError(errno.EILSEQ, 'it is not UTF-8 text', str(path)) from error


def mcap_of(path: Path) -> Path:
    """Return the MCAP file of a bag folder, or the file itself; raise DdctError without one."""
    if path.is_dir():
        files = sorted(path.glob('*.mcap'))
        if not files:
            raise DdctError(f'{path}: no .mcap file in this folder: give a bag')
        if len(files) > 1:
            raise DdctError(f'{path}: {len(files)} .mcap files in this folder: give one of them')
        return files[0]
    if not path.exists():
        raise DdctError(f'{path}: no such file or folder')
    return path
