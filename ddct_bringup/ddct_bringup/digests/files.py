# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compare the files of a folder with their digests."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.digests.digest_file import DIGESTS, Digests, file_digest, read_digests
from ddct_bringup.run.output_folder import SUFFIX
from ddct_plant.base.errors import DdctError

SAME, ALTERED, MISSING, UNLISTED = 'same', 'altered', 'missing', 'unlisted'
"""States of a file: as its digest, with other bytes, absent, and without a digest."""


@dataclass(frozen=True)
class FileState:
    """State of one file of a folder."""

    path: str
    """Path in the folder, with forward slashes."""
    state: str


def files_in(folder: Path) -> dict[str, Path]:
    """Return the files in a folder and below it by their path, without its own `digests.json`."""
    found = {
        path.relative_to(folder).as_posix(): path
        for path in folder.rglob('*')
        if (path.is_symlink() or not path.is_dir()) and not _is_lock(path)
    }
    found.pop(DIGESTS, None)
    return dict(sorted(found.items()))


def digests_of_files(folder: Path) -> dict[str, str]:
    """Return the SHA-256 of every file of a folder by its path; raise DdctError for no access."""
    return {name: file_digest(path) for name, path in files_in(folder).items()}


def file_states(folder: Path, digests: Digests) -> list[FileState]:
    """
    Return the state of every file that is listed in the digests or is in the folder.

    A symbolic link, which may point anywhere, is altered. Raise DdctError for a file that cannot
    be read.
    """
    there = files_in(folder)
    return [
        FileState(name, _state(there.get(name), digests.files.get(name)))
        for name in sorted({*there, *digests.files})
    ]


def altered_files(folder: Path, digests: Digests, names: Iterable[str]) -> list[str]:
    """Return those of the files, by their path in the folder, that exist and are altered."""
    return [
        name
        for name in names
        if name in digests.files
        and (folder / name).exists()
        and _state(folder / name, digests.files[name]) == ALTERED
    ]


def require_unaltered(folder: Path, names: Sequence[str], *, advice: str = '') -> None:
    """
    Raise DdctError for a file that is not as its digest; `names` are paths in the folder.

    With an `advice`, each that exists must have a digest. Else one without a digest is not
    checked: who goes on with a folder computes again what has none.
    """
    digests = read_digests(folder) if (folder / DIGESTS).exists() else None
    for name in names if advice else ():
        if (folder / name).exists() and (digests is None or name not in digests.files):
            raise DdctError(
                f'no digest of {name} in {DIGESTS}, by which its bytes are checked: {advice}',
                key=name,
                place=folder,
            )
    if digests is not None and (altered := altered_files(folder, digests, names)):
        raise DdctError(
            f'its bytes are not those that were written (see {DIGESTS}): put the original back',
            key=altered[0],
            place=folder / altered[0],
        )


def _state(path: Path | None, digest: str | None) -> str:
    if path is None:
        return MISSING
    if digest is None:
        return UNLISTED
    if path.is_symlink() or not path.is_file():
        return ALTERED
    return SAME if file_digest(path) == digest else ALTERED


def _is_lock(path: Path) -> bool:
    """Return whether it is the lock file of a program that is writing."""
    return path.name.startswith('.') and path.name.endswith(SUFFIX)
