# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The folder of an export: kept unless it is new, empty or an earlier export."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_text


def require_free(folder: Path, files: Iterable[str], mark: str, *, overwrite: bool) -> None:
    """
    Raise DdctError where an export would destroy something.

    The folder must be new or empty; with `overwrite` one of the `files` that is there must contain
    the text `mark`.
    """
    try:
        present = sorted(path.name for path in folder.iterdir()) if folder.exists() else []
        if present and not overwrite:
            raise DdctError(
                f'--export {folder}: holds {present[0]}; choose a new folder or add --overwrite',
                key='--export',
            )
        for file in set(files) & set(present):
            if mark not in (folder / file).read_text(encoding='utf-8', errors='replace'):
                raise DdctError(
                    f'--export {folder}: {file} is no such export; choose another folder',
                    key='--export',
                )
    except OSError as error:
        raise DdctError(
            f'--export {folder}: cannot be read ({error.strerror}); choose another folder',
            key='--export',
        ) from error


def write_files(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Write texts by file name into a folder, and return their paths; DdctError if it fails."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DdctError(
            f'--export {folder}: cannot be made ({error.strerror})', key='--export'
        ) from error
    for file, text in texts.items():
        write_text(str(folder / file), text)
    return [folder / file for file in texts]
