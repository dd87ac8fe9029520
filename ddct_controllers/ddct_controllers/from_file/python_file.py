# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in a file of Python: the one class of `Controller` that the file defines."""

import hashlib
import inspect
import re
import sys
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import TypeVar

from ddct_controllers.factories import factory_spec
from ddct_controllers.from_file.controller_file import FILE_DIGEST, text_digest
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_controllers.places import place_of_error
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError, require_name
from ddct_plant.files.input_file import located, user_text

Base = TypeVar('Base')
SUFFIX = '.py'
_PAGE = 'docs/controllers/writing_a_controller.md'


def python_spec(file: str) -> ControllerSpec[Controller]:
    """
    Return the specification of the controller in a Python file, with its class's name.

    Raise DdctError that names the file where it cannot be loaded, ParameterError where it does not
    define one controller.
    """
    path = Path(file)
    with located(f'controller file {path}'):
        text = user_text(path)
        made = _the_one(Controller, _module(path.resolve(), text), _PAGE)  # type: ignore[type-abstract]
        require_name('controller name', made.__name__)
        spec = factory_spec(made.__name__, made, str(path))
    return ControllerSpec(
        spec.name,
        spec.make,
        spec.options,
        spec.computed_from,
        {FILE_DIGEST: text_digest(text)},
    )


def the_one_class(file: str, base: type[Base], page: str) -> type[Base]:
    """
    Return the one class of `base` that a Python file defines; `page` documents its form.

    Raise DdctError that names the file where it cannot be loaded, ParameterError where it does not
    define one.
    """
    path = Path(file)
    with located(f'{base.__name__.lower()} file {path}'):
        return _the_one(base, _module(path.resolve(), user_text(path)), page)


def module_name(file: str) -> str:
    """Return the name of the module of a file, which no other module has."""
    path = Path(file).resolve()
    stem, place = re.sub(r'\W', '_', path.stem), hashlib.sha256(str(path).encode()).hexdigest()
    return f'controller_file_{stem}_{place[:8]}'


@lru_cache(maxsize=64)
def _module(path: Path, text: str) -> ModuleType:
    """Run the text, anew after each edit; modules beside the file can be imported."""
    name = module_name(str(path))
    module = ModuleType(name)
    module.__file__ = str(path)
    if (folder := str(path.parent)) not in sys.path:
        sys.path.append(folder)  # last: a file there takes the place of no other module
    sys.modules[name] = module
    try:
        exec(compile(text.encode(), str(path), 'exec', dont_inherit=True), vars(module))
    except FOREIGN_FAILURES as error:
        place = place_of_error(error, name)
        where = f', in {place}' if place else ''
        raise DdctError(
            f'it cannot be loaded ({type(error).__name__}: {error}{where}): mend its code'
        ) from error
    return module


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
