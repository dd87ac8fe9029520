# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Content of a controller file: its values, their lines, and errors that name both."""

import hashlib
import re
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_controllers.interface import CompiledCode
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.options import close_name
from ddct_plant.files.input_file import located, named_in, user_bytes, user_text
from ddct_plant.files.yaml_text import parse_yaml_with_lines

YAML_SUFFIXES = ('.yaml', '.yml')
SUFFIXES = (*YAML_SUFFIXES, '.py')
FORMAT = 'ddct-linear-controller-1'
"""Value of the key `format`, where a file has one."""
COMMON = ('format', 'name', 'provenance')
"""Optional keys of a file of every kind, beside those of its kind; only `name` is required."""
FILE_DIGEST = 'controller_file_sha256'
"""Key of the digest of a controller file on `run_info`."""
_NAME = re.compile(r'[a-z][a-z0-9_]{0,39}')


def is_controller_file(name: str) -> bool:
    """Return whether a controller's name is that of a file."""
    return name.endswith(SUFFIXES)


def require_name(name: object) -> None:
    """Raise ParameterError unless `name` can be the name of a controller."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ParameterError(
            f'controller name {name!r}: use up to 40 lower-case letters, digits and underscores, '
            'a letter first'
        )


def option_name(path: str) -> str:
    """Return the option of a value in a file or an FMU: dots and brackets become underscores."""
    return re.sub(r'\W+', '_', path).strip('_')


@dataclass(frozen=True)
class ControllerFile:
    """Content of one file, from which a loader reads its kind's keys, inside of `located`."""

    path: Path
    content: Any
    """Content as parsed from YAML; `keys` checks that it is a mapping."""
    lines: Mapping[str, int]
    """Line numbers by dotted path, from `parse_yaml_with_lines`."""
    digests: dict[str, str]
    """SHA-256 of the file and of the one that it names, by their key on `run_info`."""

    @property
    def name(self) -> str:
        """Name of the controller, which is also that of the bag's folder."""
        return str(self.content['name'])

    def keys(
        self, kind: str, required: Sequence[str] = (), optional: Sequence[str] = ()
    ) -> Mapping[str, Any]:
        """Return the content after a check of the keys of every file; raise ParameterError."""
        content = mapping('', self.content, ('name', kind, *required), (*COMMON, *optional))
        require_name(content['name'])
        if content.get('format', FORMAT) != FORMAT:
            raise ParameterError(f'format is {content["format"]!r}: it must be {FORMAT}')
        mapping('provenance', content.get('provenance') or {})
        return content

    def named_file(self, kind: str, value: object, what: str) -> Path:
        """
        Return the path of the file that the key `<kind>.file` names, and store its digest.

        Relative paths start at the controller file. Raise ParameterError when it cannot be read.
        """
        if not isinstance(value, str) or not value:
            raise ParameterError(
                f'{kind}.file is {value!r}: give the path of {what}', key=f'{kind}.file'
            )
        path = named_in(self.path.parent, value)
        try:
            data = user_bytes(path)
        except DdctError as error:
            raise ParameterError(
                f'{kind}.file: {path} {error}: give {what}', key=f'{kind}.file'
            ) from error
        self.digests[f'{kind}_sha256'] = hashlib.sha256(data).hexdigest()
        return path

    def place_of(self, kind: str) -> str:
        """Return file, line and key of a controller of this kind, for its author."""
        return f'{self.path} line {self.lines[kind]} ({kind})'

    def compiled_code(self, kind: str, path: Path) -> CompiledCode:
        """Return the compiled code in the file `path`, which the key `<kind>.file` names."""
        key = f'{kind}.file'
        return CompiledCode(path, key, f'controller file {self.path}: line {self.lines[key]}')

    def located(self) -> AbstractContextManager[None]:
        """Put file, and line where the error names a key of it, before each DdctError within."""
        return located(f'controller file {self.path}', self.lines)


def read_controller_file(file: str) -> ControllerFile:
    """Read a file of any kind; raise DdctError that names it when it cannot be read."""
    path = Path(file)
    with located(f'controller file {path}'):
        text = user_text(path)
        content, lines = parse_yaml_with_lines(text)
    return ControllerFile(path, content, lines, {FILE_DIGEST: text_digest(text)})


def text_digest(text: str) -> str:
    """Return the SHA-256 of the text of a controller file, by which a bag identifies it."""
    return hashlib.sha256(text.encode()).hexdigest()


def mapping(
    path: str, content: Any, required: Sequence[str] = (), optional: Sequence[str] = ()
) -> Mapping[str, Any]:
    """
    Return the mapping at `path` ('' is the whole file) if it has these keys.

    Without names of keys, any keys are valid. Raise ParameterError that names the wrong key.
    """
    name = path or 'the file'
    if not isinstance(content, Mapping):
        raise ParameterError(f'{name}: give keys and values, not {content!r}', key=name)
    known = (*required, *optional)
    strange = [key for key in content if key not in known] if known else []
    for key in required:
        if key not in content:
            meant = f': is it meant by {strange[0]!r}?' if strange else ''
            raise ParameterError(
                f'{name}: key {key} is missing{meant}', key=f'{path}.{key}' if path else key
            )
    for key in strange:
        full = f'{path}.{key}' if path else str(key)
        raise ParameterError(f'unknown key {full!r}: {close_name(key, known)}', key=full)
    return content
