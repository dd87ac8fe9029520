# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A folder where the documented commands find what they read, and runs that they share.

The fixtures of this module are those of `tests/docs` and `tests/nightly/docs`.
"""

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from ddct_bringup.run import execution
from ddct_bringup.run.plan import RunPlan
from ddct_controllers.registry import controller_names
from ddct_controllers.template.package import write_package
from ddct_plant.scenario.file import scenario_to_yaml
from support.documented import ROOT, blocks


def example_on(page: str) -> str:
    """Return the first example in Python of a page."""
    return next(
        block.text for block in blocks() if block.page == page and block.language == 'python'
    )


def install_example(site: Path) -> None:
    """Install the class that the page shows, and what `ddct check --new` writes, as `my_slip`."""
    code = example_on('docs/controllers/writing.md')
    package, record = site / 'my_package', site / 'my_package-1.0.dist-info'
    for folder in (package, record):
        folder.mkdir(parents=True)
    (package / '__init__.py').touch()
    (package / 'control.py').write_text(code)
    (record / 'METADATA').write_text('Metadata-Version: 2.1\nName: my_package\nVersion: 1.0\n')
    (record / 'entry_points.txt').write_text(
        '[ddct.controllers]\nproportional = my_package.control:Proportional\n'
        'my_slip = my_slip:MySlip\n'
    )
    write_package('my_slip', site / 'new')
    (site / 'new' / 'src' / 'my_slip.py').rename(site / 'my_slip.py')


@pytest.fixture(scope='session')
def install() -> Path:
    """Return the folder that colcon has installed into."""
    prefixes = [entry for entry in os.environ.get('COLCON_PREFIX_PATH', '').split(':') if entry]
    folder = Path(prefixes[0]) if prefixes else ROOT / 'install'
    if not (folder / 'setup.bash').exists():
        pytest.skip('the workspace is not built: make setup')
    return folder


@pytest.fixture(scope='session')
def furnished(install: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with what commands read and write, and the example in `site`."""
    folder = tmp_path_factory.mktemp('documented')
    without = shutil.ignore_patterns('images', 'website')  # no command reads them
    shutil.copytree(ROOT / 'docs', folder / 'docs', ignore=without)
    for part in (
        'ddct_controllers/ddct_controllers/from_file/c_library/template',
        'ddct_plant/ddct_plant/scenario/packaged',
    ):
        shutil.copytree(ROOT / part, folder / part)
    (folder / 'install').symlink_to(install)
    install_example(folder / 'site')
    (folder / 'mine.py').write_text(example_on('README.md'), encoding='utf-8')
    shutil.copy(folder / 'site' / 'my_package' / 'control.py', folder / 'proportional.py')
    return folder


@pytest.fixture
def workplace(furnished: Path) -> Iterator[Path]:
    """Return that folder; what a test has made in it is removed."""
    there = set(furnished.iterdir())
    yield furnished
    for made in set(furnished.iterdir()) - there:
        shutil.rmtree(made) if made.is_dir() else made.unlink()


@pytest.fixture(scope='session')
def run_once(tmp_path_factory: pytest.TempPathFactory) -> Callable[[RunPlan, Path], None]:
    """Return an `execute` for headless runs that simulates equal ones of ours once."""
    own = set(controller_names())
    folders: dict[tuple[str, ...], Path] = {}

    def execute(plan: RunPlan, folder: Path, *_: object) -> None:
        settings = plan.settings
        key = (str(plan.controller), scenario_to_yaml(settings.scenario), repr(settings))
        if key not in folders or plan.controller not in own:
            folders[key] = tmp_path_factory.mktemp('run')
            original(plan, folders[key])
        shutil.copytree(folders[key], folder, dirs_exist_ok=True)

    original = execution.execute
    return execute


@pytest.fixture
def shared_runs(
    run_once: Callable[[RunPlan, Path], None], workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Path]:
    """Let the commands of this process run in the workplace, which it returns, and share runs."""
    monkeypatch.chdir(workplace)
    monkeypatch.syspath_prepend(workplace / 'site')
    monkeypatch.setattr(execution, 'execute', run_once)
    yield workplace
    for module in ('my_slip', 'my_package', 'my_package.control'):
        sys.modules.pop(module, None)
