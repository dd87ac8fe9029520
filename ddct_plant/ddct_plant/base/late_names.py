# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names that a package imports when they are first used, as PEP 562 has it."""

import ast
import importlib
import inspect
import sys
from collections.abc import Callable
from typing import Any


def late_names(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """
    Return `__getattr__`, `__dir__` and `__all__` of a package that imports its names late.

    The names are those that its `__init__.py` imports under `if TYPE_CHECKING:`, so that type
    checkers and Python read one list. A name that was used once stays in the package.
    """
    places = _imports_for_type_checkers(package)

    def getattr_(name: str) -> Any:
        if name not in places:
            raise AttributeError(f'module {package!r} has no attribute {name!r}', name=name)
        found = _imported(*places[name])
        setattr(sys.modules[package], name, found)
        return found

    def dir_() -> list[str]:
        return sorted({*vars(sys.modules[package]), *places})

    return getattr_, dir_, sorted(places)


def _imported(module: str, name: str) -> Any:
    """Return what `from module import name` imports: a value of the module, or a submodule."""
    found = importlib.import_module(module)
    known = vars(found)
    return known[name] if name in known else importlib.import_module(f'{module}.{name}')


def _imports_for_type_checkers(package: str) -> dict[str, tuple[str, str]]:
    """Return module and name there of each name under `if TYPE_CHECKING:` in a package."""
    tree = ast.parse(inspect.getsource(sys.modules[package]))
    return {
        alias.asname or alias.name: (node.module or '', alias.name)
        for block in tree.body
        if isinstance(block, ast.If)
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
