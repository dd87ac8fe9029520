# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Limits of an FMU's file: its unpacked size, number of files and description.

A small ZIP file may unpack to any size, and a description may take minutes to read, or refer to
other files of the machine. So these are checked before FMPy reads the FMU.
"""

import zipfile
from collections.abc import Sequence
from pathlib import Path
from xml.parsers import expat

from ddct_plant.base.errors import ParameterError

DESCRIPTION = 'modelDescription.xml'
MOST_UNPACKED_BYTES = 1 << 29
"""Largest total size in bytes of the unpacked files."""
MOST_FILES = 10_000
MOST_DESCRIPTION_BYTES = 1 << 25
"""Largest size of the description in bytes."""
MOST_ELEMENTS = 100_000
"""Largest number of elements of the description; a variable takes one to three."""


def names_in(path: Path) -> Sequence[str]:
    """
    Return the names of the files in an FMU within these limits; raise ParameterError beyond them.

    Raise zipfile.BadZipFile, KeyError or ExpatError for a file that is no FMU.
    """
    with zipfile.ZipFile(path) as file:
        entries = file.infolist()
        # No more than these sizes is unpacked, even if the content is longer.
        size = sum(entry.file_size for entry in entries)
        if size > MOST_UNPACKED_BYTES or len(entries) > MOST_FILES:
            raise ParameterError(
                f'{path} unpacks to {len(entries)} files of {size} bytes together: export at most '
                f'{MOST_FILES} files of {MOST_UNPACKED_BYTES} bytes'
            )
        description = file.getinfo(DESCRIPTION)
        if description.file_size > MOST_DESCRIPTION_BYTES:
            raise ParameterError(
                f'{path}: {DESCRIPTION} has {description.file_size} bytes: export fewer '
                f'variables, at most {MOST_DESCRIPTION_BYTES} bytes'
            )
        _require_readable(path, file.read(description))
        return file.namelist()


def _require_readable(path: Path, description: bytes) -> None:
    """Raise ParameterError for a description with too many elements or a document type."""
    elements = 0

    def count(*_: object) -> None:
        nonlocal elements
        elements += 1
        if elements > MOST_ELEMENTS:
            raise ParameterError(
                f'{path}: {DESCRIPTION} has more than {MOST_ELEMENTS} elements: export fewer '
                'variables'
            )

    def refuse(*_: object) -> None:
        # Its entities may stand for other files, and for texts of any length.
        raise ParameterError(
            f'{path}: {DESCRIPTION} has a document type, which FMI does not have: export it again'
        )

    parser = expat.ParserCreate()
    parser.StartElementHandler = count
    parser.StartDoctypeDeclHandler = refuse
    parser.Parse(description, True)
