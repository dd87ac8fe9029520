# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The files behind a controller or a handover with their digests; none of them runs for it."""

from collections.abc import Mapping
from pathlib import Path

from ddct_controllers.from_file.controller_file import (
    FILE_DIGEST,
    is_controller_file,
    read_controller_file,
)
from ddct_controllers.from_file.kinds import kind_of
from ddct_controllers.from_file.own_modules import source_digests, sources_of
from ddct_controllers.from_file.python_file import SUFFIX
from ddct_controllers.from_file.with_options import KIND as WITH_OPTIONS
from ddct_controllers.from_file.with_options import add_base_digests, base_of
from ddct_plant.files.input_file import located

_FILE = 'file'
"""Key of every kind that names a file."""
_HANDOVER_DIGEST = 'handover_file_sha256'


def controller_digests(chosen: str) -> Mapping[str, str]:
    """
    Return `ControllerSpec.digests` of a controller by its file; a name has none.

    Code of a Python file runs when the file is loaded, so a program that compares the files with
    recorded digests does it by this function first. Raise DdctError for a file that cannot be
    read.
    """
    if not is_controller_file(chosen):
        return {}
    if chosen.endswith(SUFFIX):
        with located(f'controller file {chosen}'):
            return source_digests(FILE_DIGEST, sources_of(Path(chosen)))
    file = read_controller_file(chosen)
    with file.located():
        kind = kind_of(file)
        if kind == WITH_OPTIONS:
            add_base_digests(file, controller_digests(base_of(file)))
        content = file.content[kind]
        if isinstance(content, Mapping) and _FILE in content:
            file.named_file(kind, content[_FILE], 'the file that it names')
    return file.digests


def controller_files(chosen: str) -> list[Path]:
    """
    Return the files that a controller is made of, its own first; a name has none.

    Those are the modules beside a Python file that it imports, the library or FMU that a file
    names, and the files of a controller that is given other options. Raise DdctError for a file
    that cannot be read.
    """
    if not is_controller_file(chosen):
        return []
    if chosen.endswith(SUFFIX):
        return _python_files('controller', chosen)
    file = read_controller_file(chosen)
    with file.located():
        kind = kind_of(file)
        further = controller_files(base_of(file)) if kind == WITH_OPTIONS else []
        content = file.content[kind]
        if isinstance(content, Mapping) and _FILE in content:
            further = [file.named_file(kind, content[_FILE], 'the file that it names')]
    return [Path(chosen), *further]


def handover_files(file: str) -> list[Path]:
    """Return the Python file of a handover and the modules beside it that it imports."""
    return _python_files('handover', file)


def _python_files(what: str, file: str) -> list[Path]:
    with located(f'{what} file {file}'):
        sources = sources_of(Path(file))
    return [each.path for each in sources.values() if each.path.is_file()]


def handover_digests(file: str) -> Mapping[str, str]:
    """Return the digests of a handover's Python file; raise DdctError as for a controller."""
    with located(f'handover file {file}'):
        return source_digests(_HANDOVER_DIGEST, sources_of(Path(file)))
