# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What is heavy to import is imported where it is first needed, by no clock but by its name."""

import pkgutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest
from waiting import WITHIN_S

from ddct_bringup import api, processes, verification
from ddct_bringup.api import shell
from ddct_controllers import workflows
from ddct_plant.program.command_line import programs

ROOT = Path(__file__).resolve().parents[2]

HEAVY = {
    *('asammdf', 'bokeh', 'clarabel', 'control', 'daqp', 'distributed', 'fmpy', 'foxglove'),
    *('gymnasium', 'jinja2', 'matplotlib', 'mcap', 'numpy', 'optuna', 'osqp', 'pandas'),
    *('cffi', 'mcap_ros2', 'multiprocessing', 'pyarrow', 'rclpy', 'rosbags', 'scipy', 'zstandard'),
}
"""Packages that take from 10 ms to seconds to import."""


def heavy_after(*codes: str) -> list[set[str]]:
    """Return the heavy packages that a new Python process has imported after each code."""
    shown = "import sys; print('after:', *{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run(
        [sys.executable, '-c', '\n'.join(f'{code}\n{shown}' for code in codes)],
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=True,
    )
    found = [line.split() for line in done.stdout.splitlines() if line.startswith('after:')]
    return [HEAVY.intersection(words) for words in found]


@pytest.mark.process
def test_the_python_interface_imports_nothing_heavy() -> None:
    assert heavy_after('import ddct_bringup.api') == [set()]


PROGRAMS = {
    name: point.module
    for name, point in programs().items()
    if point.module.startswith(('ddct_bringup.programs.', 'ddct_controllers.workflows.'))
}
"""Modules of the programs that are no node, by name."""


HELP = """
from {} import main
try:
    main(['--help'])
except SystemExit as end:
    assert not end.code
"""


@pytest.mark.process
def test_the_help_of_a_program_imports_nothing_heavy() -> None:
    found = heavy_after(*map(HELP.format, PROGRAMS.values()))
    assert dict(zip(PROGRAMS, found, strict=True)) == {name: set() for name in PROGRAMS}


@pytest.mark.process
def test_a_run_imports_nothing_that_draws_tunes_or_makes_tables() -> None:
    (found,) = heavy_after('from ddct_bringup.api import run')
    assert found.isdisjoint(
        {'bokeh', 'control', 'distributed', 'jinja2', 'matplotlib', 'optuna', 'pandas', 'pyarrow'}
    )


@pytest.mark.process
@pytest.mark.slow
def test_pandas_is_imported_where_a_csv_file_is_read_alone(tmp_path: Path) -> None:
    (tmp_path / 'a.csv').write_text('t,v\n0,100\n', encoding='utf-8')
    run = "from ddct_bringup.api import run\nrun('pi', duration=0.7"
    profile = {'csv': str(tmp_path / 'a.csv'), 'time': 't', 'value': 'v', 'unit': 'N m'}
    *without, last = heavy_after(
        'import ddct_plant', f'{run})', f'{run}, set={{"engine": {profile}}})'
    )
    assert 'pandas' not in set.union(*without)
    assert 'pandas' in last


@pytest.mark.parametrize('package', [api, shell, processes, verification, workflows])
def test_every_name_of_a_package_with_late_imports_is_there(package: ModuleType) -> None:
    assert len(package.__all__) > 2
    modules = {each.name for each in pkgutil.iter_modules(package.__path__)}
    for name in package.__all__:
        found = getattr(package, name)
        assert vars(package)[name] is found, 'it is kept'
        words = getattr(found, '__name__', name).split('.')
        assert name in words or f'{words[-2]}_{words[-1]}' == name
        assert name not in modules or isinstance(found, ModuleType), 'a module hides it'
    assert set(package.__all__) <= set(dir(package))


def test_a_name_that_the_python_interface_does_not_have_is_refused() -> None:
    with pytest.raises(AttributeError, match="no attribute 'rum'"):
        getattr(api, 'rum')  # noqa: B009
