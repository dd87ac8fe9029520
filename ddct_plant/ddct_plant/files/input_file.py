# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read files of users, and report the place of an error in them.

JSON and YAML have their own modules.
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from glob import escape
from pathlib import Path
from typing import Any, TypeVar

from ddct_plant.base.errors import DdctError, ParameterError

SCHEMA_KEY = 'schema_version'
"""Key of the schema version of a file."""
_PATH = re.compile(r'[\w-]+(?:\.[\w-]+|\[\d+\])*')
_SEPARATOR = re.compile(r'[/\\]')
_PARENT = re.compile(r'(?:\.[\w-]+|\[\d+\])$')


def user_bytes(path: Path) -> bytes:
    """Return the content of a file; raise ParameterError without the path, for `located`."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise ParameterError(f'cannot be read ({error.strerror})') from error


def user_text(path: Path) -> str:
    """Return the text of a file in UTF-8; raise ParameterError as `user_bytes`."""
    try:
        return user_bytes(path).decode()
    except UnicodeDecodeError as error:
        raise ParameterError('cannot be read (it is not UTF-8 text)') from error


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


def without_folder(place: str) -> str:
    """Return a place that begins with the path of a file, on any system, without its folder."""
    return _SEPARATOR.split(place)[-1]


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
