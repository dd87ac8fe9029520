# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files of a user that a result is computed from, which it carries as copies."""

import hashlib
import os
import re
from collections.abc import Sequence
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_bytes

INPUTS = 'inputs'
"""Folder of the copies in a result."""
_OUTSIDE = 'outside_'
"""Name, before a number, of the folder for files from outside of the base."""


class InputFiles:
    """
    Content of the files by their place in a result, each placed as it is to the others.

    Files of the base stay at their path within it, so that what names them by a relative path
    finds the copies. Files that belong together, such as a controller file with the library that
    it names, stay as they are to each other.
    """

    def __init__(self, base: Path | None = None, folder: str = INPUTS) -> None:
        """Take a `base`, or that of the first files; `folder` in a result is that of its copy."""
        self.folder = folder
        self.files: dict[str, bytes] = {}
        self._bases = {} if base is None else {full_path(base): ''}

    def add(self, files: Sequence[Path | str]) -> str:
        """
        Take files that belong together; return the place of the first, relative to `folder`.

        Raise DdctError for one that cannot be read.
        """
        paths = [full_path(each) for each in files]
        base = next((each for each in self._bases if _has(each, paths)), None)
        if base is None:
            base = Path(os.path.commonpath([each.parent for each in paths]))
            count = len(self._bases)
            self._bases[base] = f'{_OUTSIDE}{count}/' if count else ''
        places = [self._bases[base] + each.relative_to(base).as_posix() for each in paths]
        for place, path in zip(places, paths, strict=True):
            try:
                self.files[f'{self.folder}/{place}'] = path.read_bytes()
            except OSError as error:
                raise DdctError(f'cannot be read ({error.strerror})', place=path) from error
        return places[0]

    def add_text(self, place: str, text: str) -> str:
        """Take a text as the file at a place relative to `folder`, and return that."""
        self.files[f'{self.folder}/{place}'] = text.encode()
        return place

    def digests(self) -> dict[str, str]:
        """Return the SHA-256 of each file by its place in the result."""
        return {
            place: hashlib.sha256(content).hexdigest()
            for place, content in sorted(self.files.items())
        }

    def copy(self, result: Path) -> None:
        """Write the files into the folder of a result; raise DdctError when that fails."""
        for place, content in self.files.items():
            path = result / place
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise DdctError(f'cannot be written ({error.strerror})', place=path) from error
            write_bytes(str(path), content)


def own_place(place: str) -> str:
    """Return a place without the folder for files from outside of the base, for a title."""
    return re.sub(rf'^{_OUTSIDE}\d+/', '', place)


def full_path(path: Path | str) -> Path:
    """Return a path from the root, without `..`; links in it stay."""
    return Path(os.path.normpath(Path(path).absolute()))


def _has(base: Path, files: Sequence[Path]) -> bool:
    return all(each.is_relative_to(base) for each in files)
