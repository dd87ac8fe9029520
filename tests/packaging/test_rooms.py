# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Imports go down only: between packages, between the rooms of a package."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from syntax import tree_of
from waiting import WITHIN_S

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
MAY_IMPORT = {
    'ddct_plant': set(),
    'ddct_reference': {'ddct_plant'},
    'ddct_controllers': {'ddct_plant', 'ddct_reference'},
    'ddct_bringup': {'ddct_plant', 'ddct_reference', 'ddct_controllers'},
}
"""By package the others of ours that it may import."""


@cache
def imports(package: str) -> tuple[tuple[Path, tuple[str, ...]], ...]:
    """Return each import of our packages: the file in its package, and the parts of the name."""
    return tuple(_imports(ROOT / package / package))


def _imports(folder: Path) -> Iterator[tuple[Path, tuple[str, ...]]]:
    for file in sorted(folder.rglob('*.py')):
        for node in ast.walk(tree_of(file)):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert not node.level, f'{file}: a relative import, not followed here'
                names = [f'{node.module}.{alias.name}' for alias in node.names]
            else:
                continue
            for name in names:
                if name.partition('.')[0] in MAY_IMPORT:
                    yield file.relative_to(folder), tuple(name.split('.'))


def room_arrows(package: str) -> dict[str, set[str]]:
    """Return by room the rooms that it imports; a module outside of all folders is a room too."""
    arrows: dict[str, set[str]] = {}
    for file, (top, *rest) in imports(package):
        room = Path(file.parts[0]).stem
        if top == package and rest and rest[0] != room:
            arrows.setdefault(room, set()).add(rest[0])
    return arrows


@pytest.mark.parametrize('package', MAY_IMPORT)
def test_no_package_imports_upward(package: str) -> None:
    upward = [
        f'{file}: {".".join(name)}'
        for file, name in imports(package)
        if name[0] not in {package, *MAY_IMPORT[package]}
    ]
    assert upward == []


@pytest.mark.parametrize('package', MAY_IMPORT)
def test_no_room_imports_in_a_circle(package: str) -> None:
    TopologicalSorter(room_arrows(package)).prepare()


TABLES_OF_NAMES = {
    'benchmark.file_names',
    'floor.metric_units',
    'thesis.table_metrics',
    'tuning.specification.packaged_specs',
    'tuning.tuned_names',
}
"""Modules that are cheap to import, from which programs take the words of their --help."""


def test_programs_call_the_python_interface_alone() -> None:
    others = {
        (file.name, '.'.join(name))
        for file, (package, *name) in imports('ddct_bringup')
        if file.parts[0] == 'programs' and package == 'ddct_bringup'
        if name[0] not in {'api', 'programs', 'processes', 'verification'}
        if '.'.join(name[:-1]) not in TABLES_OF_NAMES
    }
    assert others == set()


@pytest.mark.process
def test_controllers_load_no_design_code_before_they_need_it() -> None:
    code = (
        'import sys, ddct_controllers.registry, ddct_controllers.architecture\n'
        "print(*(name for name in sys.modules if name.startswith('ddct_controllers.design.')))"
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=WITHIN_S, check=True
    )
    assert done.stdout.split() == []


@pytest.mark.slow
def test_no_controller_or_architecture_loads_python_control_to_run():
    """Not even those that are synthesised, or the feedforward that is designed, at the start."""
    code = (
        'import sys\n'
        'from ddct_controllers.architecture import make_architecture\n'
        'from ddct_controllers.registry import controller_names, make_controller\n'
        'from ddct_plant.scenario.file import load_scenario\n'
        'from ddct_plant.scenario.settings import KnownSettings\n'
        "settings = KnownSettings(load_scenario('thesis'), 'feedforward')\n"
        'for name in controller_names():\n'
        '    make_architecture(settings, make_controller(name, settings))\n'
        "assert 'ddct_controllers.design.h_infinity.design' in sys.modules\n"
        "print('control' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=WITHIN_S, check=True
    )
    assert done.stdout.split() == ['False']


def test_no_two_test_modules_have_one_name() -> None:
    """Otherwise pytest cannot collect both at once."""
    folders = [ROOT / 'tests', *(ROOT / package / 'test' for package in MAY_IMPORT)]
    names = [file.name for folder in folders for file in folder.rglob('test_*.py')]
    assert sorted({name for name in names if names.count(name) > 1}) == []
