# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compare the files of a result with the digests in its manifest."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.manifest.inputs import full_path
from ddct_bringup.manifest.manifest import (
    MANIFEST,
    Manifest,
    file_digest,
    files_in,
    read_manifest,
    result_around,
)
from ddct_plant.base.errors import DdctError

SAME, ALTERED, MISSING, UNLISTED = 'same', 'altered', 'missing', 'unlisted'
"""States of a file: as its digest, with other bytes, absent, and without a digest."""


@dataclass(frozen=True)
class FileState:
    """State of one file of a result."""

    path: str
    """Path in the result, with forward slashes."""
    state: str


def file_states(result: Path, manifest: Manifest) -> list[FileState]:
    """
    Return the state of every file that the manifest lists or that is in the result.

    A symbolic link, which may point anywhere, is altered. Raise DdctError for a file that cannot
    be read.
    """
    there = files_in(result)
    return [
        FileState(name, _state(there.get(name), manifest.files.get(name)))
        for name in sorted({*there, *manifest.files})
    ]


def altered_files(result: Path, manifest: Manifest, names: Iterable[str]) -> list[str]:
    """Return those of the files, by their path in the result, that exist and are altered."""
    return [
        name
        for name in names
        if name in manifest.files
        and (result / name).exists()
        and _state(result / name, manifest.files[name]) == ALTERED
    ]


def require_unaltered(folder: Path, names: Sequence[str], *, advice: str = '') -> None:
    """
    Raise DdctError for a file that is not as its digest; `names` are paths in `folder`.

    The folder is that of a result, or in one. With an `advice`, each file that exists must have a
    digest. Else a file without a digest is not checked, because `--resume` computes it again.
    """
    result = result_around(folder)
    if result is None:
        raise DdctError(f'no {MANIFEST} in it: give the folder of a result', place=folder)
    manifest = read_manifest(result)
    within = full_path(folder).relative_to(result)
    places = [(within / name).as_posix() for name in names]
    for place in places if advice else ():
        if (result / place).exists() and place not in manifest.files:
            raise DdctError(
                f'no digest of {place} in {MANIFEST}, by which its bytes are checked: {advice}',
                key=place,
                place=result,
            )
    for place in altered_files(result, manifest, places):
        raise DdctError(
            f'its bytes are not those that were written (see {MANIFEST}): put the original back',
            key=place,
            place=result / place,
        )


def _state(path: Path | None, digest: str | None) -> str:
    if path is None:
        return MISSING
    if digest is None:
        return UNLISTED
    if path.is_symlink() or not path.is_file():
        return ALTERED
    return SAME if file_digest(path) == digest else ALTERED
