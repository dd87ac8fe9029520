# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What pip installs of a package holds every file that its code reads."""

import runpy
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import pytest
import setuptools
from test_dependencies import PACKAGES, ROOT


def setup_of(package: str, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Return what a package's setup.py hands to setuptools."""
    given: dict[str, Any] = {}
    monkeypatch.setattr(setuptools, 'setup', lambda **options: given.update(options))
    monkeypatch.chdir(ROOT / package)
    runpy.run_path('setup.py')
    return given


@pytest.mark.parametrize('package', PACKAGES)
def test_every_file_beside_the_code_is_package_data(
    package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = setup_of(package, monkeypatch)
    patterns = [
        f'{name.replace(".", "/")}/{pattern}'
        for name, each in given.get('package_data', {}).items()
        for pattern in each
    ]
    files = [path for path in Path(package).rglob('*') if path.is_file()]
    data = [path.as_posix() for path in files if path.suffix not in ('.py', '.pyc')]
    assert [path for path in data if not any(fnmatch(path, each) for each in patterns)] == []
    unused = [each for each in patterns if not any(fnmatch(path, each) for path in data)]
    assert unused == []


@pytest.mark.parametrize('package', PACKAGES)
def test_every_folder_of_modules_is_a_package(
    package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    folders = {
        path.parent.as_posix().replace('/', '.')
        for path in Path(ROOT / package, package).rglob('*.py')
    }
    prefix = (ROOT / package).as_posix().replace('/', '.') + '.'
    installed = setup_of(package, monkeypatch)['packages']
    assert {folder.removeprefix(prefix) for folder in folders} == set(installed)
