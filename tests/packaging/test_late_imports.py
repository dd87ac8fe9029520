# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What is heavy to import is imported where it is first needed, by no clock but by its name."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import ddct_bringup.api

HEAVY = {
    *('bokeh', 'clarabel', 'control', 'daqp', 'distributed', 'fmpy', 'foxglove', 'jinja2'),
    *('matplotlib', 'mcap', 'numpy', 'optuna', 'osqp', 'pandas', 'pyarrow', 'rclpy', 'scipy'),
    *('cffi', 'mcap_ros2', 'multiprocessing', 'rosbags', 'zstandard'),
}
"""Packages that take from 10 ms to seconds to import."""


def heavy_after(code: str) -> set[str]:
    """Return the heavy packages that a new Python process has imported after some code."""
    shown = "import sys; print('', *{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run(
        [sys.executable, '-c', f'{code}\n{shown}'],
        capture_output=True,
        text=True,
        timeout=60.0,
        check=True,
    )
    return HEAVY & set(done.stdout.rpartition('\n ')[2].split())


@pytest.mark.process
def test_the_python_interface_imports_nothing_heavy() -> None:
    assert heavy_after('import ddct_bringup.api') == set()


@pytest.mark.process
def test_a_run_imports_nothing_that_draws_tunes_or_makes_tables() -> None:
    assert heavy_after('from ddct_bringup.api import run').isdisjoint(
        {'bokeh', 'control', 'distributed', 'jinja2', 'matplotlib', 'optuna', 'pandas', 'pyarrow'}
    )


def test_every_name_of_the_python_interface_is_where_type_checkers_read_it() -> None:
    api = ddct_bringup.api
    (block,) = (
        node for node in ast.parse(Path(api.__file__).read_text()).body if isinstance(node, ast.If)
    )
    imports = [node for node in block.body if isinstance(node, ast.ImportFrom)]
    read = {alias.name: str(node.module) for node in imports for alias in node.names}
    assert sorted(read) == api.__all__
    for name, module in read.items():
        assert getattr(api, name) is getattr(sys.modules[module], name)
    assert set(api.__all__) <= set(dir(api))


def test_a_name_that_the_python_interface_does_not_have_is_refused() -> None:
    with pytest.raises(AttributeError, match="no attribute 'rum'"):
        _ = ddct_bringup.api.rum
