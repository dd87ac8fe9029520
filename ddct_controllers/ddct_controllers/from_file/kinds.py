# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The kinds of controller files, and the function from a file to its controller."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from difflib import get_close_matches
from functools import partial

from ddct_controllers.from_file.c_library.controller import c_library_spec
from ddct_controllers.from_file.controller_file import (
    COMMON,
    ControllerFile,
    mapping,
    read_controller_file,
)
from ddct_controllers.from_file.fmu.keys import fmu_spec
from ddct_controllers.from_file.python_file import SUFFIX, python_spec
from ddct_controllers.from_file.transfer_functions import BESIDE_LINEAR, LINEAR
from ddct_controllers.from_file.with_options import KIND as WITH_OPTIONS
from ddct_controllers.from_file.with_options import Find, with_options_spec
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import close_name

Loader = Callable[[ControllerFile], ControllerSpec[Controller]]
"""
Function that checks the keys of its kind and returns the controller's specification.

Errors name the key first, as `polynomial.den[2] is nan: ...`; `located` adds file and line. Slow
work, such as loading a library, is left to `ControllerSpec.make`, inside of `located` too.
"""
KINDS: Mapping[str, Loader] = {
    **LINEAR,
    'c_library': c_library_spec,
    'fmu': fmu_spec,
}
"""Loaders of controllers that no other one is a part of, by the key of their kind in a file."""
_ALL = (*KINDS, WITH_OPTIONS)


def load_spec(file: str, find: Find) -> ControllerSpec[Controller]:
    """
    Return the specification of the controller in a file; DdctError names file and line.

    `find` returns another controller that the file is made of.
    """
    if file.endswith(SUFFIX):
        return python_spec(file)
    source = read_controller_file(file)
    with source.located():
        kind = kind_of(source)
        load = KINDS.get(kind) or partial(with_options_spec, find)
        spec = load(source)
        return replace(spec, digests=source.digests, written_in=source.place_of(kind))


def kind_of(file: ControllerFile) -> str:
    """Return the key of a file's kind; raise ParameterError where there is not one."""
    choices = ', '.join(_ALL)
    kinds = [key for key in mapping('', file.content) if key in _ALL]
    if len(kinds) == 1:
        return str(kinds[0])
    if kinds:
        raise ParameterError(f'{kinds[1]} beside {kinds[0]}: keep one of {choices}', key=kinds[1])
    strange = [key for key in file.content if key not in (*COMMON, *BESIDE_LINEAR)]
    if not strange:
        raise ParameterError(f'there is no kind of controller: give one of {choices}')
    near = [key for key in strange if get_close_matches(str(key), _ALL, n=1)]
    key = (near or strange)[0]
    raise ParameterError(
        f'{key!r} is no kind of controller: {close_name(key, _ALL)}', key=str(key)
    )
