# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in a file of Python: the one class of `Controller` that the file defines."""

import inspect
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import TypeVar

from ddct_controllers.from_file.controller_file import FILE_DIGEST
from ddct_controllers.from_file.own_modules import (
    Sources,
    load_module,
    module_name,
    source_digests,
    sources_of,
)
from ddct_controllers.interface import Controller, ControllerContext, ControllerSpec
from ddct_controllers.places import place_of_error
from ddct_controllers.plugins import factory_spec
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError, require_name
from ddct_plant.files.input_file import located

Base = TypeVar('Base')
SUFFIX = '.py'
_PAGE = 'docs/controllers/writing.md'


def python_spec(file: str, *, anew: bool = True) -> ControllerSpec[Controller]:
    """
    Return the specification of the controller in a Python file, with its class's name.

    With `anew` it loads the file again for each controller that it makes: runs in one process
    share no variable of a module. Raise DdctError that names the file where it cannot be loaded,
    ParameterError where it does not define one controller.
    """
    path = Path(file)
    with located(f'controller file {path}'):
        sources = sources_of(path)
        made = _controller_class(_module(sources))
        require_name('controller name', made.__name__)
        spec = factory_spec(made.__name__, made, str(path))

    def make(context: ControllerContext) -> Controller:
        with located(f'controller file {path}'):
            again = _controller_class(_module(sources, anew=True))
        return factory_spec(spec.name, again, str(path)).make(context)

    digests = source_digests(FILE_DIGEST, sources)
    return replace(spec, make=make if anew else spec.make, digests=digests)


def the_one_class(file: str, base: type[Base], page: str) -> type[Base]:
    """
    Return the one class of `base` that a Python file defines; `page` documents its form.

    Raise DdctError that names the file where it cannot be loaded, ParameterError where it does not
    define one.
    """
    path = Path(file)
    with located(f'{base.__name__.lower()} file {path}'):
        return _the_one(base, _module(sources_of(path), anew=True), page)


def _controller_class(module: ModuleType) -> type[Controller]:
    return _the_one(Controller, module, _PAGE)  # type: ignore[type-abstract]


def _module(sources: Sources, *, anew: bool = False) -> ModuleType:
    try:
        return load_module(sources, anew=anew)
    except FOREIGN_FAILURES as error:
        name = module_name(sources)
        place = place_of_error(error, name)
        where = f', in {place}' if place else ''
        reason = f'{type(error).__name__}: {error}{where}'.replace(f'{name}.', '')
        raise DdctError(f'it cannot be loaded ({reason}): mend its code') from error


def _the_one(base: type[Base], module: ModuleType, page: str) -> type[Base]:
    """Return the class; one with abstract methods counts only if there is no other."""
    defined = [
        value
        for value in vars(module).values()
        if inspect.isclass(value)
        and issubclass(value, base)
        and value.__module__ == module.__name__
    ]
    found = [each for each in defined if not inspect.isabstract(each)] or defined
    if not found:
        raise ParameterError(
            f'it defines no class of {base.__module__}.{base.__name__}: write one ({page})'
        )
    if len(found) > 1:
        names = ', '.join(each.__name__ for each in found)
        kind = f'{base.__name__.lower()}s'
        raise ParameterError(f'it defines {len(found)} {kind}, {names}: keep one in each file')
    return found[0]
