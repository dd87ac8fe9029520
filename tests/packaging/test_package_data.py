# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What pip installs of a package holds every file that its code reads."""

from fnmatch import fnmatch
from pathlib import Path

import pytest
from test_dependencies import PACKAGES, ROOT, setup_of


@pytest.mark.parametrize('package', PACKAGES)
def test_every_file_beside_the_code_is_package_data(
    package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT / package)
    given = setup_of(package)
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
def test_every_folder_of_modules_is_a_package(package: str) -> None:
    folders = {
        path.parent.as_posix().replace('/', '.')
        for path in Path(ROOT / package, package).rglob('*.py')
    }
    prefix = (ROOT / package).as_posix().replace('/', '.') + '.'
    installed = setup_of(package)['packages']
    assert {folder.removeprefix(prefix) for folder in folders} == set(installed)
