# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Find the bags at the paths that a user gives, and name them."""

from collections.abc import Iterable
from pathlib import Path

from ddct_bringup.run.timing_and_failure import NOTE_FILE
from ddct_plant.base.errors import DdctError


def bags_in(paths: Iterable[Path]) -> list[tuple[Path, Path | None]]:
    """
    Return (bag, searched folder or None) for every bag at the paths, each once.

    Raise DdctError for a path without a bag.
    """
    found: dict[Path, tuple[Path, Path | None]] = {}
    for path in paths:
        for bag in find_bags(path):
            found.setdefault(bag.resolve(), (bag, None if bag == path else path))
    return list(found.values())


def bag_name(path: Path, relative_to: Path | None) -> str:
    """Return the name of a bag in scores: its path with forward slashes."""
    if relative_to is not None and path.is_relative_to(relative_to):
        return path.relative_to(relative_to).as_posix()
    return path.as_posix()


def find_bags(path: Path) -> list[Path]:
    """
    Return the bags in a folder and below it, or the bag at `path`, in alphabetical order.

    A folder with one .mcap file is a bag; of several files in a folder each is one. The folder of
    a failed run counts even without a file. Hidden files and folders do not count. Raise DdctError
    without any bag.
    """
    if not path.is_dir():
        if not path.exists():
            raise DdctError(f'{path}: no such file or folder')
        return [path]
    files = _visible(path, '*.mcap')
    recorded = {file.parent for file in files}
    files += [note for note in _visible(path, NOTE_FILE) if note.parent not in recorded]
    files.sort()
    if not files:
        raise DdctError('no .mcap file in this folder or below it: give a bag', place=path)
    folders = [file.parent for file in files]
    return [
        folder if folders.count(folder) == 1 else file
        for file, folder in zip(files, folders, strict=True)
    ]


def _visible(folder: Path, pattern: str) -> list[Path]:
    return [
        file
        for file in folder.rglob(pattern)
        if not any(part.startswith('.') for part in file.relative_to(folder).parts)
    ]
