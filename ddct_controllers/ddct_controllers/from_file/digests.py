# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Digests of the files behind a controller or a handover, taken without running any of them."""

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


def handover_digests(file: str) -> Mapping[str, str]:
    """Return the digests of a handover's Python file; raise DdctError as for a controller."""
    with located(f'handover file {file}'):
        return source_digests(_HANDOVER_DIGEST, sources_of(Path(file)))
