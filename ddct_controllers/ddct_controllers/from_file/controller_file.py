"""A controller file as it was read: its values, their lines, and errors that name both."""

import hashlib
import re
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import close_name
from ddct_plant.files.input_file import located, read_file, user_text
from ddct_plant.files.yaml_text import parse_yaml_with_lines

MOST_BINARY_BYTES = 1 << 30
"""Largest size of a library or an FMU that a controller file names."""
SUFFIXES = ('.yaml', '.yml', '.py')
FORMAT = 'ddct-linear-controller-1'
"""Value of the key `format`, where one is given."""
COMMON = ('format', 'name', 'provenance')
"""Keys that a file of every kind may hold beside those of its kind; `name` it must."""
_NAME = re.compile(r'[a-z][a-z0-9_]{0,39}')


def is_controller_file(name: str) -> bool:
    """Say whether a controller's name is that of a file."""
    return name.endswith(SUFFIXES)


def require_name(name: object) -> None:
    """Raise ParameterError unless a controller can be called `name`."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ParameterError(
            f'controller name {name!r}: use up to 40 lower-case letters, digits and underscores, '
            'a letter first'
        )


@dataclass(frozen=True)
class ControllerFile:
    """What one file holds. A loader reads its kind's keys from it, inside of `located`."""

    path: Path
    content: Any
    """As YAML has it; `keys` checks that it is a mapping."""
    lines: Mapping[str, int]
    """Line numbers by dotted path, as `parse_yaml_with_lines` gives them."""
    digests: dict[str, str]
    """SHA-256 of the file and of the one that it names, by their key on `run_info`."""

    @property
    def name(self) -> str:
        """What the controller is called; it names the folder of the bag."""
        return str(self.content['name'])

    def keys(
        self, kind: str, required: Sequence[str] = (), optional: Sequence[str] = ()
    ) -> Mapping[str, Any]:
        """Return the whole content with what every file has checked; raise ParameterError."""
        content = mapping('', self.content, ('name', kind, *required), (*COMMON, *optional))
        require_name(content['name'])
        if content.get('format', FORMAT) != FORMAT:
            raise ParameterError(f'format is {content["format"]!r}: it must be {FORMAT}')
        mapping('provenance', content.get('provenance') or {})
        return content

    def named_file(self, kind: str, value: object, what: str) -> Path:
        """
        Return the path of the file that the key `<kind>.file` names, and note its digest.

        Relative paths start at the controller file. Raise ParameterError when it cannot be read.
        """
        if not isinstance(value, str) or not value:
            raise ParameterError(f'{kind}.file is {value!r}: give the path of {what}')
        path = self.path.parent / value
        try:
            data = read_file(path, MOST_BINARY_BYTES)
        except OSError as error:
            raise ParameterError(
                f'{kind}.file: {path} cannot be read ({error.strerror}): give {what}'
            ) from error
        self.digests[f'{kind}_sha256'] = hashlib.sha256(data).hexdigest()
        return path

    def place_of(self, kind: str) -> str:
        """Return where its author finds what is of a kind: file, line and key."""
        return f'{self.path} line {self.lines[kind]} ({kind})'

    def located(self) -> AbstractContextManager[None]:
        """Put file, and line where the error names a key of it, before each DdctError within."""
        return located(f'controller file {self.path}', self.lines)


def read_controller_file(file: str) -> ControllerFile:
    """Read a file of any kind; raise DdctError that names it when it cannot be read."""
    path = Path(file)
    with located(f'controller file {path}'):
        text = user_text(path)
        content, lines = parse_yaml_with_lines(text)
    digest = hashlib.sha256(text.encode()).hexdigest()
    return ControllerFile(path, content, lines, {'controller_file_sha256': digest})


def mapping(
    path: str, content: Any, required: Sequence[str] = (), optional: Sequence[str] = ()
) -> Mapping[str, Any]:
    """
    Return what stands at `path` ('' is the whole file) when it has these keys; else complain.

    Where no key is named, any will do. Raise ParameterError that names the key.
    """
    name = path or 'the file'
    if not isinstance(content, Mapping):
        raise ParameterError(f'{name}: give keys and values, not {content!r}')
    known = (*required, *optional)
    strange = [key for key in content if key not in known] if known else []
    for key in required:
        if key not in content:
            meant = f': is it meant by {strange[0]!r}?' if strange else ''
            raise ParameterError(f'{name}: key {key} is missing{meant}')
    for key in strange:
        full = f'{path}.{key}' if path else str(key)
        raise ParameterError(f'unknown key {full!r}: {close_name(key, known)}')
    return content
