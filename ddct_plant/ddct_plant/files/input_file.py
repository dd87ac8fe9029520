# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read files of users, and report the place of an error in them.

JSON and YAML have their own modules.
"""

import codecs
import errno
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from glob import escape
from io import BufferedReader
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

from ddct_plant.base.errors import DdctError, ParameterError

MOST_TEXT_BYTES = 1_000_000
"""Largest size in bytes of a scenario, controller or page: hundreds of times the usual one."""
_BLOCK_BYTES = 1_000_000
SCHEMA_KEY = 'schema_version'
"""Key of the schema version of a file."""
_PATH = re.compile(r'[\w-]+(?:\.[\w-]+|\[\d+\])*')
_PARENT = re.compile(r'(?:\.[\w-]+|\[\d+\])$')


def open_file(path: Path) -> BufferedReader:
    """
    Open a file to read it; raise OSError where that fails, and for a pipe, which may never end.

    The `strerror` of the error is a message for the user.
    """
    if path.is_fifo():
        raise OSError(errno.EINVAL, 'it is a pipe: give a file', str(path))
    return path.open('rb')


def read_file(path: Path, most_bytes: int) -> bytes:
    """Return the content of a file; raise OSError as `open_file`, and above `most_bytes`."""
    with open_file(path) as file:
        # In blocks: in one go Python would reserve memory for as many bytes as there may be.
        blocks = iter(partial(file.read, _BLOCK_BYTES), b'')
        data = b''.join(islice(blocks, most_bytes // _BLOCK_BYTES + 1))
    if len(data) > most_bytes:
        raise OSError(errno.EFBIG, f'it is larger than {most_bytes} bytes', str(path))
    return data


def read_text_file(path: Path, most_bytes: int = MOST_TEXT_BYTES) -> str:
    """Return the text of a UTF-8 file; raise OSError as `read_file`, and for other bytes."""
    try:
        return read_file(path, most_bytes).decode('utf-8')
    except UnicodeDecodeError as error:
        raise OSError(errno.EILSEQ, 'it is not UTF-8 text', str(path)) from error


def any_text(data: bytes) -> str:
    """
    Return the text of bytes from another tool, in one of the usual encodings.

    A byte order mark decides for UTF-8 or UTF-16. Without one the encoding is UTF-8 where that is
    possible, else Windows-1252, else Latin-1. Raise ParameterError for bytes that are no text.
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encodings = ['utf-16']
    else:
        encodings = ['utf-8-sig', 'cp1252', 'latin-1']
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if '\0' not in text:
            return text
    raise ParameterError('it is no text: give a file of text, best in UTF-8')


def user_text(path: Path) -> str:
    """Return the text of `read_text_file`; raise DdctError without the path, for `located`."""
    try:
        return read_text_file(path)
    except OSError as error:
        raise DdctError(f'cannot be read ({error.strerror})') from error


@contextmanager
def located(name: str, lines: Mapping[str, int] | None = None) -> Iterator[None]:
    """
    Prefix each DdctError within by a name, such as a file's, and by the line of the key it names.

    `lines` are those of `parse_yaml_with_lines`; without them no line is given.
    """
    try:
        yield
    except DdctError as error:
        line = line_of(f'{error.key} {error}', lines or {})
        raise error.at(f'{name}: line {line}' if line else name) from error


def line_of(text: str, lines: Mapping[str, int]) -> int:
    """Return the line of the first key in an error text as `entry_of`, 0 where no key has one."""
    return entry_of(text, lines) or 0


Entry = TypeVar('Entry')


def entry_of(text: str, entries: Mapping[str, Entry]) -> Entry | None:
    """
    Return the entry of the first key in an error text, or else of the section of that key.

    An error text names the key to change first. The result is None where no key has one.
    """
    for word in _PATH.findall(text):
        while word and word not in entries:
            word = _PARENT.sub('', word) if _PARENT.search(word) else ''
        if word:
            return entries[word]
    return None


def require_schema_version(content: Mapping[str, Any], newest: int) -> None:
    """
    Raise ParameterError unless the schema version of a file is supported, 1 to `newest`.

    A file without a version has `newest`. An older program thus reports a newer file.
    """
    version = content.get(SCHEMA_KEY, newest)
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise ParameterError(
            f'{SCHEMA_KEY} is {version!r}: give a whole number from 1 to {newest}', key=SCHEMA_KEY
        )
    if version > newest:
        raise ParameterError(
            f'{SCHEMA_KEY} is {version}, this version reads up to {newest}: update the project',
            key=SCHEMA_KEY,
        )


def named_in(folder: Path, name: str) -> Path:
    """
    Return the path of a file that another one in a folder names; a relative one starts there.

    In the folder `inputs` of a result an absolute one is that of the copy, where there is one.
    """
    around = (folder.absolute(), *folder.absolute().parents)
    inputs = next((each for each in around if each.name == 'inputs'), None)
    if Path(name).is_absolute() and inputs and _is_result(inputs.parent):
        parts = Path(name).parts
        for first in range(1, len(parts)):
            for copy in inputs.rglob(escape('/'.join(parts[first:]))):
                return copy
    return folder / name


def _is_result(folder: Path) -> bool:
    """Return whether a folder is that of a result, perhaps one that is being made."""
    return any((folder / name).is_file() for name in ('manifest.json', '.ddct-output'))


def mcap_of(path: Path) -> Path:
    """Return the MCAP file of a bag folder, or the file itself; raise DdctError without one."""
    if path.is_dir():
        files = sorted(path.glob('*.mcap'))
        if not files:
            raise DdctError('no .mcap file in this folder: give a bag', place=path)
        if len(files) > 1:
            raise DdctError(
                f'{len(files)} .mcap files in this folder: give one of them', place=path
            )
        return files[0]
    if not path.exists():
        raise DdctError('no such file or folder', place=path)
    return path
