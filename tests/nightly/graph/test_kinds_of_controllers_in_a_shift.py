# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A gear shift in the graph with a controller of each kind, as headless."""

import shutil
from pathlib import Path

import pytest
from support.exported_mpc import compile_c
from support.fmu import controller_file, skip_without_fmus
from support.shifts_in_a_graph import CONTROLLER, require_shift_from_files

from ddct_controllers.from_file.c_library.library import TEMPLATE

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.compiler
@pytest.mark.parametrize('kind', ['python file', 'transfer function', 'C library', 'FMU'])
def test_a_controller_of_any_kind_and_a_handover_in_a_file_shift_in_the_graph_as_headless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.chdir(tmp_path)
    require_shift_from_files(_file_of(kind), 'single-process', tmp_path / 'run')


def _file_of(kind: str) -> str:
    """Return a controller file of a kind in the present folder."""
    if kind == 'FMU':
        skip_without_fmus()
        return controller_file(2)
    if kind == 'C library':
        for file in TEMPLATE.iterdir():
            shutil.copy(file, file.name)
        compile_c(Path(), '-O2', '-shared', '-fPIC', 'my_controller.c', '-o', 'my_controller.so')
        return 'my_controller.yaml'
    if kind == 'transfer function':
        return str(ROOT / 'docs' / 'templates' / 'transfer_function.yaml')
    Path('mine.py').write_text(CONTROLLER, encoding='utf-8')
    return 'mine.py'
