# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each public name of the plant's rooms for all packages has a reader outside of its room."""

import ast
import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

import pytest
from syntax import tree_of

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
WITHIN = {
    'base': (),
    'files': (
        *('date_times.is_date_time', 'date_times.seconds_since_first'),
        *(f'json_records.{name}' for name in ('LISTS', 'MAPPINGS', 'UNIONS')),
        *(f'json_records.{name}' for name in ('choices_of', 'fields_of', 'is_record', 'keys_of')),
    ),
    'program': (
        'help_text.HelpFormatter',
        *(f'operating_system.{name}' for name in ('c_library', 'end_with', 'flush_c_output')),
        'operating_system.open_files_stay',
        *(f'operating_system.{name}' for name in ('processor_features', 'processor_name')),
        *('signals.interruptible', 'signals.is_first_report', 'signals.stems_from_interrupt'),
    ),
}
"""By room the names that its modules share, and no other room reads."""


def modules_of(folders: Iterable[Path]) -> dict[str, ast.Module]:
    """Return the syntax of the modules of packages in `folders`, by the modules' names."""
    return {
        '.'.join(file.relative_to(folder.parent).with_suffix('').parts).removesuffix(
            '.__init__'
        ): tree_of(file)
        for folder in folders
        for file in folder.rglob('*.py')
    }


@cache
def product() -> dict[str, ast.Module]:
    """Return the modules of all packages."""
    return modules_of(ROOT / package / package for package in PACKAGES)


def public_names(tree: ast.Module) -> Iterator[str]:
    """Yield the public functions, classes and constants of a module, but no type variables."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names = [node.name]
        elif isinstance(node, ast.Assign) and not ast.unparse(node.value).startswith('TypeVar('):
            names = [target.id for target in node.targets if isinstance(target, ast.Name)]
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names = [node.target.id]
        else:
            continue
        yield from (name for name in names if not name.startswith('_'))


def imported(tree: ast.Module) -> dict[str, str]:
    """Return by the name in a module the full name of what it imports."""
    found: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.asname: alias.name for alias in node.names if alias.asname}
        elif isinstance(node, ast.ImportFrom):
            found |= {
                alias.asname or alias.name: f'{node.module}.{alias.name}' for alias in node.names
            }
    return found


@cache
def read_names(tree: ast.Module) -> set[str]:
    """Return the full names that a module imports, or reads as attributes of modules."""
    names = imported(tree)

    def dotted(node: ast.expr) -> str:
        if isinstance(node, ast.Attribute):
            return f'{dotted(node.value)}.{node.attr}'
        return names.get(node.id, node.id) if isinstance(node, ast.Name) else ''

    attributes = {dotted(node) for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    return {*names.values(), *attributes}


def without_reader(modules: dict[str, ast.Module], room: str, entry_points: str = '') -> list[str]:
    """Return the public names of a room that no module outside imports, nor an entry point."""
    inside = {name for name in modules if name == room or name.startswith(f'{room}.')}
    passed_on = {
        f'{module}.{name}': full
        for module in inside
        for name, full in imported(modules[module]).items()
    }
    read = {f'{module}.{name}' for module, name in re.findall(r'([\w.]+):(\w+)', entry_points)}
    for module in modules.keys() - inside:
        for name in read_names(modules[module]):
            read |= {name, passed_on.get(name, name)}
    public = (f'{name}.{each}' for name in inside for each in public_names(modules[name]))
    return sorted(name for name in public if name not in read)


@pytest.mark.parametrize('room', WITHIN)
def test_each_public_name_of_a_room_for_all_is_imported_outside_of_it(room: str) -> None:
    """Otherwise it is private in its module, or one of the few that modules of a room share."""
    modules = product()
    scripts = ''.join((ROOT / package / 'setup.py').read_text() for package in PACKAGES)
    within = [f'ddct_plant.{room}.{name}' for name in WITHIN[room]]
    assert without_reader(modules, f'ddct_plant.{room}', scripts) == within
    others = {name: read_names(tree) for name, tree in modules.items()}
    for name in within:
        own = name.rpartition('.')[0]
        assert any(name in read for module, read in others.items() if module != own), name


def test_every_way_to_read_a_name_counts_and_its_own_room_does_not(tmp_path: Path) -> None:
    (tmp_path / 'ours' / 'room').mkdir(parents=True)
    sources = {
        'room/one': 'A = 1\nB = 2\nC: int = 3\ndef d(): ...\nclass E: ...\n_F = 4\n'
        'def main(): ...\nT = TypeVar("T")\ndef unread(): ...\nUNREAD = 5\n',
        'room/two': 'from ours.room.one import E, unread\nunread()\n',
        'other': 'import ours.room.one\nfrom ours.room import one\nfrom ours.room.one import A\n'
        'from ours.room.two import E\nimport ours.room.one as o\nours.room.one.B, one.C, o.d()\n',
    }
    for name, source in sources.items():
        (tmp_path / 'ours' / f'{name}.py').write_text(source, encoding='utf-8')
    modules = modules_of([tmp_path / 'ours'])
    expected = ['ours.room.one.UNREAD', 'ours.room.one.unread']
    assert without_reader(modules, 'ours.room', "'main = ours.room.one:main'") == expected
