# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The modules beside a Python file that it imports: they are a part of it, and of no other file.

Their names are below that of the file's module, so another file may have others of these names.
"""

import ast
import builtins
import hashlib
import importlib
import importlib.metadata
import re
import sys
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

from ddct_controllers.from_file.controller_file import text_digest
from ddct_plant.files.input_file import located, user_text
from ddct_plant.program.operating_system import carry

_SUFFIX, _INIT = '.py', '__init__.py'


@dataclass(frozen=True)
class Source:
    """File and text of one module."""

    path: Path
    text: str
    """Text of the file; '' for a folder of modules without an `__init__.py`."""
    is_package: bool
    """Whether other modules are below it."""


Sources = Mapping[str, Source]
"""The modules of a file by their names in its folder, as 'parts.filter'; '' is the file itself."""


def sources_of(file: Path) -> Sources:
    """
    Return a Python file and the modules in its folder that it imports, also through one another.

    `import` statements count, also those in functions; of a package all modules do. Modules of the
    standard library and of installed packages come before those in the folder. Nothing runs.
    Raise DdctError for a file that cannot be read.
    """
    path = file.resolve()
    found = {'': Source(path, user_text(path), is_package=True)}
    waiting = ['']
    while waiting:
        importer = waiting.pop()
        absolute, relative = _imports(found[importer].text)
        if importer and (found[importer].is_package or '.' in importer):
            relative = frozenset()  # they stay in the package, which counts anyway
        for name in absolute | relative:
            files = {} if name in found else _files_of(name, path.parent)
            if path in files.values():
                continue  # an import of the file itself is refused when it runs
            if files and (name in relative or not _comes_first(name)):
                found |= {each: _source(file) for each, file in files.items()}
                waiting += files
    return dict(sorted(found.items()))


def source_digests(file_key: str, sources: Sources) -> dict[str, str]:
    """
    Return the SHA-256 of the texts: of the file by `file_key`, of others by the path beside it.

    A module without text has none.
    """
    folder = sources[''].path.parent
    digests = {file_key: text_digest(sources[''].text)}
    for name, source in sources.items():
        if name and source.text:
            key = f'{source.path.relative_to(folder).as_posix()}_sha256'
            digests[key] = text_digest(source.text)
    return digests


def module_name(sources: Sources) -> str:
    """Return the name of a file's module, which no other file has, nor this one with an edit."""
    content = repr([(str(source.path), source.text) for source in sources.values()])
    stem = re.sub(r'\W', '_', sources[''].path.stem)
    return f'controller_file_{stem}_{hashlib.sha256(content.encode()).hexdigest()[:12]}'


def load_module(sources: Sources, *, anew: bool = False) -> ModuleType:
    """
    Return the module of a file; after an edit, or `anew`, it runs again with all of its own.

    Objects of an earlier load keep the modules that they have. Raise whatever its code raises;
    then no module of it stays.
    """
    name = module_name(sources)
    _find_too({name: sources})
    if anew:
        _forget(name)
    try:
        return importlib.import_module(name)
    except BaseException:
        _forget(name)
        raise


def _forget(name: str) -> None:
    """Remove the module of a file and its own from the loaded ones."""
    for each in [each for each in sys.modules if each.partition('.')[0] == name]:
        del sys.modules[each]


class _Finder(MetaPathFinder, Loader):
    """Finds and runs the modules of files, whose `import` statements find one another."""

    def __init__(self) -> None:
        self.sources: dict[str, Sources] = {}
        """Modules of each file, by the name of the file's module."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return what `import` needs; a package has no path, so no other file is found in it."""
        package, _, name = fullname.partition('.')
        sources = self.sources.get(package, {})
        source = sources.get(name)
        if source is None:
            if sources and name == sources[''].path.stem:
                # A second module of it would have classes and variables of its own.
                raise ImportError(f'{sources[""].path.name} imports itself')
            return None
        spec = ModuleSpec(fullname, self, origin=str(source.path), is_package=source.is_package)
        spec.has_location = True
        return spec

    def exec_module(self, module: ModuleType) -> None:
        """Run the text of a module, with an `import` of its own."""
        package, _, name = module.__name__.partition('.')
        source = self.sources[package][name]
        own_import = partial(self._import, package)
        vars(module)['__builtins__'] = {**vars(builtins), '__import__': own_import}
        code = compile(source.text.encode(), str(source.path), 'exec', dont_inherit=True)
        exec(code, vars(module))

    def _import(
        self,
        package: str,
        name: str,
        globals: Any = None,
        locals: Any = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        """Do what `__import__` does, for a module of the file whose module is `package`."""
        top, sources = name.partition('.')[0], self.sources[package]
        own = top in sources or top == sources[''].path.stem
        if level or not own or _comes_first(top):
            return builtins.__import__(name, globals, locals, fromlist or (), level)
        found = builtins.__import__(f'{package}.{name}', globals, locals, fromlist or ())
        return found if fromlist else sys.modules[f'{package}.{top}']


_FINDER = _Finder()


def _find_too(modules: Mapping[str, Sources]) -> None:
    """Let `import` find the modules of files, by the names of the files' modules."""
    _FINDER.sources.update(modules)
    if _FINDER not in sys.meta_path:
        sys.meta_path.append(_FINDER)


carry(lambda: _FINDER.sources, _find_too)


def _comes_first(name: str) -> bool:
    """Return whether a module of the standard library or of an installed package has a name."""
    return name in sys.stdlib_module_names or name in _installed()


@cache
def _installed() -> frozenset[str]:
    return frozenset(importlib.metadata.packages_distributions())


@lru_cache(maxsize=256)
def _imports(text: str) -> tuple[frozenset[str], frozenset[str]]:
    """Return the first parts of the names that a text imports, absolute and relative to `.`."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # they come when the text runs
            nodes = list(ast.walk(ast.parse(text.encode())))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return frozenset(), frozenset()  # the same error comes with its place when the text runs
    absolute, relative = set(), set()
    for node in nodes:
        match node:
            case ast.Import(names=names):
                absolute |= {each.name for each in names}
            case ast.ImportFrom(module=str(module), level=0):
                absolute.add(module)
            case ast.ImportFrom(module=None, names=names, level=1):
                relative |= {each.name for each in names}
            case ast.ImportFrom(module=str(module), level=1):
                relative.add(module)
    return _first_parts(absolute), _first_parts(relative)


def _first_parts(names: set[str]) -> frozenset[str]:
    return frozenset(name.partition('.')[0] for name in names)


def _files_of(name: str, folder: Path) -> dict[str, Path]:
    """Return the files of the module `name` in a folder, and of those below it, by their names."""
    package, module = folder / name, folder / f'{name}{_SUFFIX}'
    if module.is_file() and not (package / _INIT).is_file():
        return {name: module}
    files = {}
    for path in package.rglob(f'*{_SUFFIX}'):
        parts = path.relative_to(folder).with_suffix('').parts
        if all(part.isidentifier() for part in parts):
            for depth in range(1, len(parts)):  # folders, some without an __init__.py
                files['.'.join(parts[:depth])] = folder.joinpath(*parts[:depth], _INIT)
            if path.name != _INIT:
                files['.'.join(parts)] = path
    return files


def _source(path: Path) -> Source:
    is_package = path.name == _INIT
    if is_package and not path.exists():
        return Source(path, '', is_package)
    with located(str(path)):
        return Source(path, user_text(path), is_package)
